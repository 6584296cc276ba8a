// SPDX-License-Identifier: BSD-3-Clause
// Units of elements other than tet4; fans.cpp has those.
#include "operator/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cells/hex8.hpp"
#include "operator/fans.hpp"

namespace kacanov {
namespace {

/// Whether the nodes on edges lie in the middle of them, to rounding of the edge.
bool straight(const MeshView& mesh, const std::int32_t* node) {
  const Cell& type = cell(mesh.type);
  const std::size_t dim = type.dim;
  const auto x = [&](std::int8_t a, std::size_t k) { return mesh.coordinates[dim * node[a] + k]; };
  for (const CellEdge& edge : type.edges) {
    double off = 0.0, side = 0.0;
    for (std::size_t k = 0; edge.middle >= 0 && k < dim; ++k) {
      off = std::max(off, std::abs(x(edge.middle, k) - 0.5 * (x(edge.a, k) + x(edge.b, k))));
      side = std::max(side, std::abs(x(edge.a, k) - x(edge.b, k)));
    }
    if (off > 1e-13 * side) return false;
  }
  return true;
}

/// Whether a hex8 is one: each edge is that of the first corner along its direction, to rounding
/// of the element's own extent along each axis.
bool parallelepiped(const MeshView& mesh, const std::int32_t* node) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 8> x;
    for (std::size_t a = 0; a < 8; ++a) x[a] = mesh.coordinates[3 * static_cast<std::size_t>(node[a]) + k];
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double along[3] = {x[1] - x[0], x[3] - x[0], x[4] - x[0]};
    for (std::size_t a = 0; a < 8; ++a) {
      double expected = x[0];
      for (std::size_t direction = 0; direction < 3; ++direction)
        if (elements::Hex8::corner[a][direction] > 0) expected += along[direction];
      if (std::abs(x[a] - expected) > 1e-13 * (*high - *low)) return false;
    }
  }
  return true;
}

simd::Shape shape_of(const MeshView& mesh, std::size_t element) {
  const std::int32_t* node = &mesh.connectivity[element * nodes_per_element(mesh.type)];
  const bool is_affine = mesh.type == ElementType::hex8 ? parallelepiped(mesh, node)
                         : cell(mesh.type).order == 2   ? straight(mesh, node)
                                                        : false;
  return is_affine ? simd::Shape::affine : simd::Shape::general;
}

}  // namespace

std::uint32_t Units::nodes_of(simd::Shape shape, std::uint32_t length) const {
  switch (shape) {
    case simd::Shape::open_fan: return length + 3;
    case simd::Shape::closed_fan: return length + 2;
    case simd::Shape::affine:
    case simd::Shape::general: break;
  }
  return static_cast<std::uint32_t>(nodes_per_element(type));
}

std::uint32_t Units::points_of(simd::Shape shape, std::uint32_t length) const {
  switch (shape) {
    case simd::Shape::open_fan:
    case simd::Shape::closed_fan: return length;
    case simd::Shape::affine:
    case simd::Shape::general: break;
  }
  return static_cast<std::uint32_t>(points_per_element(type));
}

Units make_units(const Body& body) {
  const MeshView& mesh = body.mesh;
  if (mesh.type == ElementType::tet4) return cover_by_fans(body);
  Units result;
  result.type = mesh.type;
  result.nodes.assign(mesh.connectivity.begin(), mesh.connectivity.end());
  const auto nodes = static_cast<std::uint32_t>(nodes_per_element(mesh.type));
  for (std::uint32_t e = 0; e < mesh.element_count(); ++e) {
    result.units.push_back({shape_of(mesh, e), 1, body.law_index(e), e * nodes, e});
    result.elements.push_back(static_cast<std::int32_t>(e));
  }
  return result;
}

}  // namespace kacanov
