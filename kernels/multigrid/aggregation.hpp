// SPDX-License-Identifier: BSD-3-Clause
// Groups of strongly coupled nodes, by pairwise matching.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov {

/// A symmetric graph in compressed rows, without its diagonal: both directions of an edge are stored.
struct WeightedGraph {
  std::vector<std::int64_t> start;   ///< rows + 1
  std::vector<std::int32_t> column;  ///< an entry an edge of a row
  std::vector<float> weight;         ///< likewise; positive; larger: stronger

  std::int32_t rows() const noexcept { return static_cast<std::int32_t>(start.size()) - 1; }
};

/// Group of each row (theory: aggregation). Rows, then pairs, then fours ... are joined along their heaviest
/// edges until groups have `size` ≥ 1 rows in the mean, but for those that have no neighbours, or nothing is
/// left to join. Groups are numbered from 0 in the order of their first rows. Not collective: rows of this
/// rank alone.
std::vector<std::int32_t> aggregate(WeightedGraph graph, double size);

/// The same for the first `nodes` nodes of a body (those a rank owns) by their couplings; g: elements ×
/// points, a stress.
struct NodeAggregation {
  double size = 48.0;
  /// Nodes that are grouped at a time, neighbours in the numbering: a graph of all would be the largest array
  /// of a run.
  std::int32_t section = 1 << 15;
  int threads = 1;  ///< which change nothing but the time
};
std::vector<std::int32_t> aggregate_nodes(const Body& body, std::span<const double> g, std::int32_t nodes,
                                          const NodeAggregation& options);

}  // namespace kacanov
