// SPDX-License-Identifier: BSD-3-Clause
// Averages of tr ε around corners (theory: displacement-pressure): their place in the blocks, and the sums
// over threads and over processes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/index_map.hpp>
#include <kacanov/scatterer.hpp>
#include "operator/layout.hpp"

namespace kacanov {

/// A corner of a block: its local node, the entry of its average, and the place that accumulates its volume
/// change: the entry's own, or, if several threads add to the entry, a private place of the thread behind all
/// entries.
struct BlockCorner {
  std::uint32_t node;
  std::int32_t entry, place;
};

struct CornerLayout {
  std::size_t entries = 0, places = 0;  ///< places: entries, then the threads' private places
  std::vector<std::size_t> first;       ///< corners of block b: first[b] … first[b+1]
  std::vector<BlockCorner> corners;
  /// Places to add to an entry: shared_first[i] … [i+1] of shared_place belong to shared_entry[i].
  std::vector<std::int32_t> shared_entry, shared_place;
  std::vector<std::size_t> shared_first;

  std::span<const BlockCorner> of(std::size_t block) const {
    return std::span(corners).subspan(first[block], first[block + 1] - first[block]);
  }
  std::size_t bytes() const noexcept;
};

CornerLayout make_corner_layout(const Body& body, const CornerMeans& means, const Layout& layout);

/// ∫ N over the elements of each corner or patch, as in reference::corner_changes().
std::vector<double> corner_volumes(const Body& body, const CornerMeans& means);

/// Splits blocks in which a corner has several entries, so that each corner has one entry per block.
void separate_moduli(const Body& body, Partitioning& partitioning);

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

/// The function that BasicOperator::set_corner_sum() expects, for `Real` float or double. Copies share
/// buffers.
template <class Real>
class CornerSum {
 public:
  /// `nodes`: index map of the nodes. All processes must have the same `moduli`. Collective.
  CornerSum(const CornerMeans& means, const IndexMap& nodes);
  /// Sums each entry over all processes. Collective.
  void operator()(std::span<Real> entries);

 private:
  struct State {
    explicit State(CornerRows all);
    CornerRows rows;
    std::vector<Real> values;  ///< of the rows; zero in rows without an entry on this rank
    Scatterer<Real> scatterer;
  };
  std::shared_ptr<State> state_;  ///< null with one process
};

}  // namespace kacanov
