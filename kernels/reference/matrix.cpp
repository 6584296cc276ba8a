// SPDX-License-Identifier: BSD-3-Clause
// The operator as a matrix, assembled element by element.
#include "reference/matrix.hpp"

#include <algorithm>

#include "cells/elements.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"

namespace kacanov {

void element_stiffness(const Body& body, std::size_t element, std::span<const double> g,
                       std::span<double> matrix) {
  const Law& law = body.law(element);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    using Point = elements::Point<E>;
    constexpr std::size_t width = E::nodes * E::dim;
    elements::Nodal<E> x;
    const std::int32_t* node = body.mesh.connectivity.data() + element * E::nodes;
    for (int a = 0; a < E::nodes; ++a)
      for (int i = 0; i < E::dim; ++i) x[Point::at(a, i)] = body.mesh.coordinates[Point::at(node[a], i)];
    std::fill_n(matrix.begin(), width * width, 0.0);
    const auto points = elements::points_of<E>(x, law.mean_dilatation, body.mesh.plane);
    for (std::size_t q = 0; q < E::points; ++q) {
      const Point& point = points[q];
      const double shear = point.volume * g[q],
                   modulus =
                       body.mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g[q]) : law.bulk,
                   bulk = point.volume * modulus;
      for (int a = 0; a < E::nodes; ++a)
        for (int b = a; b < E::nodes; ++b) {  // the rest by symmetry
          const double* p = point.gradient[a];
          const double* r = point.gradient[b];
          const double* mean_p = point.dilatation[a];
          const double* mean_r = point.dilatation[b];
          double product = 0.0;
          for (int k = 0; k < E::dim; ++k) product += p[k] * r[k];
          const double hoop = 2.0 * point.hoop[a] * point.hoop[b];
          for (int i = 0; i < E::dim; ++i)
            for (int j = 0; j < E::dim; ++j)
              matrix[Point::at(a, i) * width + Point::at(b, j)] +=
                  bulk * mean_p[i] * mean_r[j] +
                  shear * (p[j] * r[i] - 2.0 / 3.0 * point.trace(a, i) * point.trace(b, j) +
                           (i == j ? product + (i == 0 ? hoop : 0.0) : 0.0));
        }
    }
    for (std::size_t row = 0; row < width; ++row)
      for (std::size_t column = 0; column < row; ++column)
        matrix[row * width + column] = matrix[column * width + row];
  });
}

}  // namespace kacanov

namespace kacanov::reference {
namespace {

/// Adds the matrix of one element, in which the components of a node are contiguous.
void add(const Body& body, const NodeGraph& graph, std::size_t element, std::span<const double> matrix,
         std::span<double> value) {
  const std::size_t dim = dimension(body.mesh.type), nodes = nodes_per_element(body.mesh.type);
  const auto at = body.mesh.connectivity.subspan(element * nodes, nodes);
  for (std::size_t a = 0; a < nodes; ++a) {
    const std::int64_t begin = graph.first[at[a]], end = graph.first[at[a] + 1];
    const std::size_t width = (end - begin) * dim;  // entries of a row
    for (std::size_t b = 0; b < nodes; ++b) {
      const auto row = graph.neighbour.begin() + begin;
      const auto place = std::lower_bound(row, graph.neighbour.begin() + end, at[b]) - row;
      for (std::size_t r = 0; r < dim; ++r)
        for (std::size_t c = 0; c < dim; ++c)
          value[begin * dim * dim + r * width + place * dim + c] +=
              matrix[(a * dim + r) * nodes * dim + b * dim + c];
    }
  }
}

}  // namespace

NodeGraph node_graph(const MeshView& mesh) {
  const std::size_t nodes = nodes_per_element(mesh.type);
  std::vector<std::vector<std::int32_t>> of(mesh.node_count());
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto at = mesh.connectivity.subspan(e * nodes, nodes);
    for (const std::int32_t a : at)
      for (const std::int32_t b : at) {
        auto& list = of[a];
        const auto place = std::lower_bound(list.begin(), list.end(), b);
        if (place == list.end() || *place != b) list.insert(place, b);
      }
  }
  NodeGraph graph{{0}, {}};
  for (std::size_t i = 0; i < of.size(); ++i) {
    auto& list = of[i];
    if (list.empty()) list.push_back(static_cast<std::int32_t>(i));  // belongs to no element
    graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
    graph.first.push_back(static_cast<std::int64_t>(graph.neighbour.size()));
    list = {};
  }
  return graph;
}

std::int64_t entries(const NodeGraph& graph, int dim) { return graph.first.back() * dim * dim; }

void assemble(const Body& body, const NodeGraph& graph, std::span<const double> g, std::span<const double> u,
              const MatrixRows& rows) {
  const int dim = dimension(body.mesh.type);
  const std::size_t nodes = graph.first.size() - 1;
  std::size_t at = 0;
  for (std::size_t i = 0; i < nodes; ++i)
    for (int r = 0; r < dim; ++r) {
      if (!rows.first.empty()) rows.first[i * dim + r] = static_cast<std::int64_t>(at);
      for (std::int64_t k = graph.first[i]; k < graph.first[i + 1]; ++k)
        for (int c = 0; c < dim; ++c, ++at)
          if (!rows.column.empty()) rows.column[at] = graph.neighbour[k] * dim + c;
    }
  if (!rows.first.empty()) rows.first[nodes * dim] = static_cast<std::int64_t>(at);
  if (rows.value.empty()) return;
  std::fill(rows.value.begin(), rows.value.end(), 0.0);
  const std::size_t size = nodes_per_element(body.mesh.type) * dim;
  const std::size_t points = points_per_element(body.mesh.type);
  std::vector<double> matrix(size * size);
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    if (u.empty())
      element_matrix(body, e, g.subspan(e * points, points), matrix);
    else
      element_tangent(body, e, u, matrix);
    add(body, graph, e, matrix, rows.value);
  }
}

}  // namespace kacanov::reference
