// SPDX-License-Identifier: BSD-3-Clause
// Assembled secant stiffness of one rank's elements.
#include "amg/assembly.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "reference/element_stiffness.hpp"

namespace kacanov {

std::size_t NodeGraph::position(std::int32_t row, std::int32_t column_node) const {
  const auto first = column.begin() + start[row];
  const auto last = column.begin() + start[static_cast<std::size_t>(row) + 1];
  return static_cast<std::size_t>(std::lower_bound(first, last, column_node) - column.begin());
}

NodeGraph node_graph(const MeshView& mesh) {
  const std::size_t npe = nodes_per_element(mesh.type);
  const std::size_t nodes = mesh.node_count(), elements = mesh.element_count();

  std::vector<std::int64_t> first(nodes + 1, 0);
  for (const std::int32_t n : mesh.connectivity) ++first[static_cast<std::size_t>(n) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::int32_t> element_of(mesh.connectivity.size());
  auto at = first;
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t a = 0; a < npe; ++a)
      element_of[at[mesh.connectivity[e * npe + a]]++] = static_cast<std::int32_t>(e);

  NodeGraph graph;
  graph.start.reserve(nodes + 1);
  graph.start.push_back(0);
  std::vector<std::int32_t> row;
  for (std::size_t n = 0; n < nodes; ++n) {
    row.assign(1, static_cast<std::int32_t>(n));
    for (auto k = first[n]; k < first[n + 1]; ++k) {
      const std::size_t e = element_of[k];
      const auto element = mesh.connectivity.subspan(e * npe, npe);
      row.insert(row.end(), element.begin(), element.end());
    }
    std::sort(row.begin(), row.end());
    graph.column.insert(graph.column.end(), row.begin(), std::unique(row.begin(), row.end()));
    graph.start.push_back(static_cast<std::int64_t>(graph.column.size()));
  }
  return graph;
}

std::vector<double> assemble_blocks(const Body& body, std::span<const double> g, const NodeGraph& graph) {
  const auto& mesh = body.mesh;
  const std::size_t npe = nodes_per_element(mesh.type);
  const std::size_t points = points_per_element(mesh.type);
  const std::size_t dim = dimension(mesh.type);
  const std::size_t width = npe * dim;
  std::vector<double> value(graph.column.size() * dim * dim, 0.0), local(width * width);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    element_stiffness(body, e, g.subspan(e * points, points), local);
    const auto element = mesh.connectivity.subspan(e * npe, npe);
    for (std::size_t a = 0; a < npe; ++a)
      for (std::size_t b = 0; b < npe; ++b) {
        double* to = &value[graph.position(element[a], element[b]) * dim * dim];
        for (std::size_t i = 0; i < dim; ++i)
          for (std::size_t j = 0; j < dim; ++j) to[i * dim + j] += local[(a * dim + i) * width + b * dim + j];
      }
  }
  return value;
}

void kept_secant(const Part& part, std::span<const double> kept, std::span<double> g) {
  const Body body = part.body();
  if (kept.empty())
    for (std::size_t i = 0; i < g.size(); ++i) g[i] = body.law(i / (g.size() / part.element_count())).shear;
  else
    std::copy(kept.begin(), kept.end(), g.begin());
}

}  // namespace kacanov
