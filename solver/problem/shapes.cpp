// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of a cell at a point, as spatial vectors, evaluated from the cell table.
#include "problem/shapes.hpp"

#include <algorithm>

namespace kacanov {

const Cell& corner_cell(const Cell& cell) {
  return *std::find_if(cells().begin(), cells().end(), [&](const Cell& other) {
    return other.dim == cell.dim && other.simplex == cell.simplex && other.order == 1;
  });
}

Shapes shapes_at(const Cell& cell, const Vector3& at) {
  Shapes shapes;
  std::array<double, 3 * most_nodes> gradients;
  cell.values(at.data(), shapes.value.data());
  cell.gradients(at.data(), gradients.data());
  const auto nodes = static_cast<std::size_t>(cell.nodes), dim = static_cast<std::size_t>(cell.dim);
  for (std::size_t k = 0; k < nodes; ++k)
    for (std::size_t c = 0; c < dim; ++c) shapes.gradient[k][c] = gradients[k * dim + c];
  return shapes;
}

}  // namespace kacanov
