// SPDX-License-Identifier: BSD-3-Clause
// Tests arrays that come from outside before a kernel trusts them.
#include "operator/mesh_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cells/dispatch.hpp"

namespace kacanov {
namespace {

/// det J at a point, over the product of the lengths of J's columns: 1 for orthogonal edges, 0 for a flat
/// element, negative for an inverted one, whatever its size.
template <class E>
double shape_of_map(const MeshView& mesh, std::size_t element, const double* xi) {
  constexpr std::size_t dim = E::dim;
  const auto gradients = E::gradients(xi);
  std::array<std::array<double, 3>, 3> column{};
  if constexpr (dim == 2) column[2][2] = 1.0;
  for (std::size_t k = 0; k < dim; ++k)
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t a = 0; a < E::nodes; ++a) {
        const std::size_t node = mesh.connectivity[element * E::nodes + a];
        column[k][i] += mesh.coordinates[node * dim + i] * gradients[a * dim + k];
      }
  const auto& [a, b, c] = column;
  const double det = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                     a[2] * (b[0] * c[1] - b[1] * c[0]);
  double lengths = 1.0;
  for (const auto& v : column) lengths *= std::hypot(v[0], v[1], v[2]);
  return lengths > 0.0 ? det / lengths : 0.0;
}

template <class E>
std::string element_fault(const MeshView& mesh) {
  constexpr double flat = 1e-14;  // the size of the determinant's rounding
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (const auto& xi : E::point) {
      const double shape = shape_of_map<E>(mesh, e, xi.data());
      if (shape < -flat) return "element " + std::to_string(e) + " is inverted (nodes in the wrong order?)";
      if (!(shape > flat)) return "element " + std::to_string(e) + " is degenerate: it has no volume";
    }
  return {};
}

}  // namespace

std::string arrays_fault(const MeshView& mesh) {
  const std::size_t dim = dimension(mesh.type);
  const std::size_t nodes = nodes_per_element(mesh.type);
  if (mesh.coordinates.size() % dim != 0)
    return "coordinates: expected a multiple of " + std::to_string(dim) + " values";
  if (mesh.connectivity.size() % nodes != 0)
    return "connectivity: expected a multiple of " + std::to_string(nodes) + " indices";
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    if (!std::isfinite(mesh.coordinates[i]))
      return "coordinates: those of node " + std::to_string(i / dim) + " are not finite";
  for (std::size_t i = 0; i < mesh.connectivity.size(); ++i) {
    const std::int32_t node = mesh.connectivity[i];
    if (node < 0 || static_cast<std::size_t>(node) >= mesh.node_count())
      return "connectivity: element " + std::to_string(i / nodes) + " refers to node " +
             std::to_string(node) + ", counted from 0; the body has " + std::to_string(mesh.node_count());
  }
  if (mesh.plane != PlaneState::strain && dim != 2)
    return "plane: expected plane strain, as the mesh is not flat";
  for (std::size_t i = 0; i < mesh.node_count() && mesh.plane == PlaneState::axisymmetric; ++i)
    if (mesh.coordinates[2 * i] < 0.0)
      return "coordinates: node " + std::to_string(i) + " of an axisymmetric mesh has a radius below 0";
  return {};
}

std::string mesh_fault(const MeshView& mesh) {
  if (std::string fault = arrays_fault(mesh); !fault.empty()) return fault;
  return elements::dispatch(mesh.type, [&]<class E>(E) { return element_fault<E>(mesh); });
}

bool is_inverted(const MeshView& mesh, std::size_t element) {
  return elements::dispatch(mesh.type, [&]<class E>(E) {
    return std::all_of(E::point.begin(), E::point.end(),
                       [&](const auto& xi) { return shape_of_map<E>(mesh, element, xi.data()) < 0.0; });
  });
}

}  // namespace kacanov
