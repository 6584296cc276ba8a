// SPDX-License-Identifier: BSD-3-Clause
// The assembled secant stiffness of one rank's elements, in blocks of nodes: what algebraic multigrid needs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference.hpp"

namespace kacanov {

/// Block CSR over local nodes; the rows of shared nodes hold this rank's contributions only.
struct BlockMatrix {
  int dim = 3;
  std::vector<std::int64_t> start;   ///< nodes + 1
  std::vector<std::int32_t> column;  ///< ascending within a row
  std::vector<double> value;         ///< entries × dim × dim, row-major blocks

  std::size_t rows() const noexcept { return start.size() - 1; }
  /// Block at (row, column), which must be in the pattern.
  double* block(std::int32_t row, std::int32_t column_node);
};

/// Pattern of the node graph, values zero.
BlockMatrix node_graph(const Body& body);
/// Overwrites the values with the sum of the element matrices for frozen g (elements × points).
void assemble(const Body& body, std::span<const double> g, BlockMatrix& matrix);

}  // namespace kacanov
