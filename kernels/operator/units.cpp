// SPDX-License-Identifier: BSD-3-Clause
// Units of single elements; fans.cpp makes those of several.
#include "operator/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cells/hex8.hpp"
#include "cells/straight.hpp"
#include "operator/fans.hpp"

namespace kacanov {
namespace {

/// Whether a hex8 is a parallelepiped: each edge equals the first corner's edge in its direction, up to
/// rounding of the element's extent along each axis.
bool parallelepiped(const MeshView& mesh, const std::int32_t* node) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 8> x;
    for (std::size_t a = 0; a < 8; ++a) x[a] = mesh.coordinates[3 * static_cast<std::size_t>(node[a]) + k];
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double rounding =
        4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(*low), std::abs(*high));
    const double along[3] = {x[1] - x[0], x[3] - x[0], x[4] - x[0]};
    for (std::size_t a = 0; a < 8; ++a) {
      double off = x[a] - x[0];
      for (std::size_t direction = 0; direction < 3; ++direction)
        if (elements::Hex8::corner[a][direction] > 0) off -= along[direction];
      if (std::abs(off) > 1e-13 * (*high - *low) + rounding) return false;
    }
  }
  return true;
}

/// Nodes of the first element in a tet10 fan, and the offset to those of the next element; p, q and their
/// midpoint belong to all elements.
constexpr std::uint32_t quadratic_fan_nodes[10] = {0, 1, 3, 7, 2, 5, 4, 8, 6, 9};
constexpr std::uint32_t quadratic_fan_step = 4;

}  // namespace

std::uint32_t Units::nodes_of(simd::Shape shape, std::uint32_t length) const {
  switch (shape) {
    case simd::Shape::open_fan:
      return type == ElementType::tet10 ? quadratic_fan_step * length + 6 : length + 3;
    case simd::Shape::closed_fan: return length + 2;
    case simd::Shape::affine:
    case simd::Shape::general: break;
  }
  return static_cast<std::uint32_t>(nodes_per_element(type));
}

std::uint32_t Units::points_of(simd::Shape shape, std::uint32_t length) const {
  switch (shape) {
    case simd::Shape::open_fan:
    case simd::Shape::closed_fan: return static_cast<std::uint32_t>(points_per_element(type)) * length;
    case simd::Shape::affine:
    case simd::Shape::general: break;
  }
  return static_cast<std::uint32_t>(points_per_element(type));
}

std::uint32_t Units::node_of(simd::Shape shape, std::uint32_t length, std::uint32_t i,
                             std::uint32_t a) const {
  if (shape != simd::Shape::open_fan && shape != simd::Shape::closed_fan) return a;
  if (type == ElementType::tet10) {
    const std::uint32_t first = quadratic_fan_nodes[a];
    return first < 3 ? first : first + quadratic_fan_step * i;
  }
  return a < 2 ? a : 2 + (i + a - 2) % (nodes_of(shape, length) - 2);
}

Units make_units(const Body& body) {
  const MeshView& mesh = body.mesh;
  const auto nodes = static_cast<std::uint32_t>(nodes_per_element(mesh.type));
  std::vector<bool> single(mesh.element_count(), mesh.type != ElementType::tet4);
  const auto first_node = [&](std::size_t e) { return &mesh.connectivity[e * nodes]; };
  for (std::size_t e = 0; mesh.type == ElementType::tet10 && e < single.size(); ++e)
    single[e] = !elements::has_straight_sides(elements::coordinates_of<elements::Tet10>(mesh, e));
  Units result;
  if (cell(mesh.type).simplex && dimension(mesh.type) == 3) result = cover_by_fans(body, single);
  result.type = mesh.type;
  for (std::uint32_t e = 0; e < single.size(); ++e) {
    if (!single[e]) continue;
    const bool affine = mesh.type == ElementType::hex8 && parallelepiped(mesh, first_node(e));
    result.units.push_back({affine ? simd::Shape::affine : simd::Shape::general, 1, body.law_index(e),
                            static_cast<std::uint32_t>(result.nodes.size()),
                            static_cast<std::uint32_t>(result.elements.size())});
    result.nodes.insert(result.nodes.end(), first_node(e), first_node(e) + nodes);
    result.elements.push_back(static_cast<std::int32_t>(e));
  }
  return result;
}

}  // namespace kacanov
