// SPDX-License-Identifier: BSD-3-Clause
// Corner averages over several ranks: one row per average, owned by the rank that owns its node.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/index_map.hpp>

namespace kacanov {

/// One row per place and bulk modulus that some rank averages, on the rank that owns the node with the number
/// of the place; sorted by place, then by modulus.
struct CornerRows {
  IndexMap map;                        ///< of the rows; every rank has copies of the rows of its entries
  std::vector<std::int32_t> of_entry;  ///< per entry: local index of its row
  std::vector<std::int32_t> node;      ///< per owned row: local node
  std::vector<std::int32_t> modulus;   ///< per owned row: index into `moduli`
};

/// `nodes`: index map of the nodes. All ranks must have the same `moduli`. Collective.
CornerRows make_corner_rows(const CornerMeans& means, const IndexMap& nodes);

}  // namespace kacanov
