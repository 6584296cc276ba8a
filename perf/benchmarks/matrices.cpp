// SPDX-License-Identifier: BSD-3-Clause
// Assembly on the node graph; the block product keeps the sums of a row in registers.
#include "matrices.hpp"

#include <algorithm>
#include <utility>

#include "reference/matrix.hpp"

namespace kacanov::perf {
namespace {

template <int dim>
void apply_rows(const Matrices& m, std::span<const double> x, std::span<double> y, int threads) {
  const auto rows = static_cast<std::ptrdiff_t>(m.block_first.size()) - 1;
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    double sum[dim] = {};
    const auto begin = m.block_first[row];
    const auto end = m.block_first[static_cast<std::size_t>(row) + 1];
    for (auto b = begin; b < end; ++b) {
      const double* block = m.block.data() + static_cast<std::ptrdiff_t>(dim) * dim * b;
      const double* from = x.data() + static_cast<std::ptrdiff_t>(dim) * m.block_column[b];
      for (int c = 0; c < dim; ++c)
        for (int r = 0; r < dim; ++r) sum[r] += block[dim * c + r] * from[c];
    }
    for (int r = 0; r < dim; ++r) y[row * dim + r] = sum[r];
  }
}

}  // namespace

void Matrices::apply_blocks(std::span<const double> x, std::span<double> y, int threads) const {
  if (dim == 3)
    apply_rows<3>(*this, x, y, threads);
  else
    apply_rows<2>(*this, x, y, threads);
}

double Matrices::bytes_of_blocks() const {
  return static_cast<double>(block.size() * 8 + block_column.size() * 4 + block_first.size() * 4);
}

double Matrices::bytes_of_csr() const {
  return static_cast<double>(value.size() * 8 + column.size() * 4 + first.size() * 4);
}

Matrices assemble(const Body& body, std::span<const double> g) {
  Matrices m;
  m.dim = dimension(body.mesh.type);
  const std::size_t dim = m.dim;
  const std::size_t nodes = nodes_per_element(body.mesh.type);
  const std::size_t points = points_per_element(body.mesh.type);
  const std::size_t rows = body.mesh.node_count(), count = body.mesh.element_count();
  const auto connectivity = body.mesh.connectivity;
  reference::NodeGraph graph = reference::node_graph(body.mesh);
  m.block_first.assign(graph.first.begin(), graph.first.end());
  m.block_column = std::move(graph.neighbour);
  m.block.assign(m.block_column.size() * dim * dim, 0.0);
  const std::size_t n = nodes * dim;
  std::vector<double> matrix(n * n);
  for (std::size_t e = 0; e < count; ++e) {
    reference::element_matrix(body, e, g.subspan(e * points, points), matrix);
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = 0; b < nodes; ++b) {
        const std::size_t row = connectivity[e * nodes + a];
        const auto begin = m.block_column.begin() + m.block_first[row];
        const auto end = m.block_column.begin() + m.block_first[row + 1];
        const std::size_t at =
            std::lower_bound(begin, end, connectivity[e * nodes + b]) - m.block_column.begin();
        for (std::size_t r = 0; r < dim; ++r)
          for (std::size_t c = 0; c < dim; ++c)
            m.block[at * dim * dim + c * dim + r] += matrix[(a * dim + r) * n + b * dim + c];
      }
  }
  m.first.push_back(0);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t r = 0; r < dim; ++r) {
      for (std::size_t b = m.block_first[row]; b < static_cast<std::size_t>(m.block_first[row + 1]); ++b)
        for (std::size_t c = 0; c < dim; ++c) {
          m.column.push_back(m.block_column[b] * m.dim + static_cast<std::int32_t>(c));
          m.value.push_back(m.block[b * dim * dim + c * dim + r]);
        }
      m.first.push_back(static_cast<std::int32_t>(m.value.size()));
    }
  return m;
}

}  // namespace kacanov::perf
