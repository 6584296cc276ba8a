// SPDX-License-Identifier: BSD-3-Clause
// Aggregation of strongly coupled nodes by pairwise matching.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov {

/// A symmetric graph in compressed row storage, without its diagonal; it stores both directions of an edge.
struct WeightedGraph {
  std::vector<std::int64_t> start;   ///< size rows + 1
  std::vector<std::int32_t> column;  ///< one entry per edge of a row
  std::vector<float> weight;         ///< likewise; positive, larger for stronger edges

  std::int32_t rows() const noexcept { return static_cast<std::int32_t>(start.size()) - 1; }
};

/// Returns the group of each row (theory: aggregation). Joins rows, then pairs, then groups of four ... along
/// their heaviest edges until groups have `size` ≥ 1 rows on average, not counting rows without neighbours,
/// or nothing can be joined. Groups are numbered from 0 in the order of their first rows. Not collective:
/// only rows of this rank.
std::vector<std::int32_t> aggregate(WeightedGraph graph, double size);

/// Options for grouping the first `nodes` nodes of a body (those that a rank owns) by their couplings; `g`:
/// elements × points, a stress.
struct NodeAggregation {
  double size = 48.0;
  /// Number of consecutive nodes grouped at a time: a graph of all nodes would be the largest array of a run.
  std::int32_t section = 1 << 15;
  int threads = 1;  ///< affects only the time
};
std::vector<std::int32_t> aggregate_nodes(const Body& body, std::span<const double> g, std::int32_t nodes,
                                          const NodeAggregation& options);

}  // namespace kacanov
