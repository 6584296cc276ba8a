// SPDX-License-Identifier: BSD-3-Clause
// Groups of strongly coupled nodes, by pairwise matching.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov {

/// A symmetric graph in compressed rows, without its diagonal.
struct WeightedGraph {
  std::vector<std::int64_t> start;  ///< rows + 1
  std::vector<std::int32_t> column;
  std::vector<float> weight;  ///< positive; larger: stronger

  std::int32_t rows() const noexcept { return static_cast<std::int32_t>(start.size()) - 1; }
};

/// Group of each row. Rows, then pairs, then fours ... are joined along their heaviest edges until groups
/// have `size` rows in the mean or nothing is left to join. Groups are numbered in the order of their first
/// rows.
std::vector<std::int32_t> aggregate(WeightedGraph graph, double size);

/// The same for the first `nodes` nodes of a body by their couplings, some `section` nodes at a time,
/// neighbours in the numbering: a graph of all would be the largest array of a run.
std::vector<std::int32_t> aggregate_nodes(const Body& body, std::span<const double> g, std::int32_t nodes,
                                          double size, std::int32_t section = 1 << 16);

}  // namespace kacanov
