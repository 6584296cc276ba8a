// SPDX-License-Identifier: BSD-3-Clause
// The assembled secant stiffness of one rank's elements, in blocks of nodes.
#include "assembly.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace kacanov {

double* BlockMatrix::block(std::int32_t row, std::int32_t column_node) {
  const auto first = column.begin() + start[static_cast<std::size_t>(row)];
  const auto last = column.begin() + start[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(first, last, column_node) - column.begin();
  return value.data() + static_cast<std::size_t>(at) * static_cast<std::size_t>(dim * dim);
}

BlockMatrix node_graph(const Body& body) {
  const auto& mesh = body.mesh;
  const auto npe = static_cast<std::size_t>(nodes_per_element(mesh.type));
  const std::size_t nodes = mesh.node_count(), elements = mesh.element_count();

  std::vector<std::int64_t> first(nodes + 1, 0);
  for (const std::int32_t n : mesh.connectivity) ++first[static_cast<std::size_t>(n) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::int32_t> element_of(mesh.connectivity.size());
  auto at = first;
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t a = 0; a < npe; ++a)
      element_of[static_cast<std::size_t>(at[static_cast<std::size_t>(mesh.connectivity[e * npe + a])]++)] =
          static_cast<std::int32_t>(e);

  BlockMatrix matrix;
  matrix.dim = dimension(mesh.type);
  matrix.start.reserve(nodes + 1);
  matrix.start.push_back(0);
  std::vector<std::int32_t> row;
  for (std::size_t n = 0; n < nodes; ++n) {
    row.clear();
    for (auto k = first[n]; k < first[n + 1]; ++k) {
      const auto e = static_cast<std::size_t>(element_of[static_cast<std::size_t>(k)]);
      const auto element = mesh.connectivity.subspan(e * npe, npe);
      row.insert(row.end(), element.begin(), element.end());
    }
    std::sort(row.begin(), row.end());
    matrix.column.insert(matrix.column.end(), row.begin(), std::unique(row.begin(), row.end()));
    matrix.start.push_back(static_cast<std::int64_t>(matrix.column.size()));
  }
  matrix.value.assign(matrix.column.size() * static_cast<std::size_t>(matrix.dim * matrix.dim), 0.0);
  return matrix;
}

void assemble(const Body& body, std::span<const double> g, BlockMatrix& matrix) {
  const auto& mesh = body.mesh;
  const auto npe = static_cast<std::size_t>(nodes_per_element(mesh.type));
  const auto points = static_cast<std::size_t>(points_per_element(mesh.type));
  const auto dim = static_cast<std::size_t>(matrix.dim);
  const std::size_t width = npe * dim;
  std::vector<double> local(width * width);
  std::fill(matrix.value.begin(), matrix.value.end(), 0.0);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    reference::element_matrix(body, e, g.subspan(e * points, points), local);
    const auto element = mesh.connectivity.subspan(e * npe, npe);
    for (std::size_t a = 0; a < npe; ++a)
      for (std::size_t b = 0; b < npe; ++b) {
        double* to = matrix.block(element[a], element[b]);
        for (std::size_t i = 0; i < dim; ++i)
          for (std::size_t j = 0; j < dim; ++j) to[i * dim + j] += local[(a * dim + i) * width + b * dim + j];
      }
  }
}

}  // namespace kacanov
