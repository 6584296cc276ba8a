// SPDX-License-Identifier: BSD-3-Clause
// The means round corners over several ranks: a row for each, owned by the rank that has its node.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/index_map.hpp>

namespace kacanov {

/// A row for every place and bulk modulus that some rank averages, on the rank that owns the node of that
/// number, ascending by both.
struct CornerRows {
  IndexMap map;                        ///< of the rows; every rank has a copy of those of its entries
  std::vector<std::int32_t> of_entry;  ///< local index
  std::vector<std::int32_t> node;      ///< of an owned row: local node
  std::vector<std::int32_t> modulus;   ///< of an owned row: which of `moduli`
};

/// `nodes`: the map of the nodes. All ranks have to have the same `moduli`. Collective.
CornerRows make_corner_rows(const CornerMeans& means, const IndexMap& nodes);

}  // namespace kacanov
