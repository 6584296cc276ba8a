// SPDX-License-Identifier: BSD-3-Clause
// Groups of strongly coupled nodes, by pairwise matching.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference.hpp"

namespace kacanov {

/// A symmetric graph in compressed rows, without its diagonal.
struct WeightedGraph {
  std::vector<std::int64_t> start;  ///< rows + 1
  std::vector<std::int32_t> column;
  std::vector<float> weight;        ///< positive; larger: stronger

  std::int32_t rows() const noexcept { return static_cast<std::int32_t>(start.size()) - 1; }
};

/// Couplings of the first `nodes` nodes of a body: Σ g / distance² over the elements two nodes share, g (elements ×
/// points) taken in the mean. In flat or stretched elements the short edges are the strong ones.
WeightedGraph coupling_graph(const Body& body, std::span<const double> g, std::int32_t nodes);

/// Group of each row. Rows, then pairs, then fours ... are joined along their heaviest edges until groups have `size` rows
/// in the mean or nothing is left to join. Groups are numbered in the order of their first rows.
std::vector<std::int32_t> aggregate(WeightedGraph graph, double size);

}  // namespace kacanov
