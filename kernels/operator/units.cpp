// SPDX-License-Identifier: BSD-3-Clause
// Units of elements other than tet4; fans.cpp has those.
#include "operator/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cells/hex8.hpp"
#include "cells/tet10.hpp"
#include "operator/fans.hpp"

namespace kacanov {
namespace {

/// Whether the mid-side nodes of a tet10 lie in the middle of their sides.
bool straight(const MeshView& mesh, const std::int32_t* node) {
  const auto x = [&](std::size_t a, std::size_t k) {
    return mesh.coordinates[3 * static_cast<std::size_t>(node[a]) + k];
  };
  for (std::size_t m = 0; m < 6; ++m) {
    const auto a = static_cast<std::size_t>(elements::Tet10::edge[m][0]);
    const auto b = static_cast<std::size_t>(elements::Tet10::edge[m][1]);
    double off = 0.0, side = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      off = std::max(off, std::abs(x(4 + m, k) - 0.5 * (x(a, k) + x(b, k))));
      side = std::max(side, std::abs(x(a, k) - x(b, k)));
    }
    if (off > 1e-13 * side) return false;
  }
  return true;
}

/// Whether a hex8 is a parallelepiped: each edge is that of the first corner along its direction, to rounding
/// of the element's own extent along each axis.
bool affine(const MeshView& mesh, const std::int32_t* node) {
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

}  // namespace

std::uint32_t nodes_of(simd::Shape shape, std::uint32_t length) noexcept {
  switch (shape) {
    case simd::Shape::open_fan: return length + 3;
    case simd::Shape::closed_fan: return length + 2;
    case simd::Shape::tri3: return 3;
    case simd::Shape::tet10:
    case simd::Shape::curved_tet10: return 10;
    case simd::Shape::hex8:
    case simd::Shape::affine_hex8: return 8;
  }
  return 0;
}

std::uint32_t points_of(simd::Shape shape, std::uint32_t length) noexcept {
  switch (shape) {
    case simd::Shape::open_fan:
    case simd::Shape::closed_fan: return length;
    case simd::Shape::tri3: return 1;
    case simd::Shape::tet10:
    case simd::Shape::curved_tet10: return 4;
    case simd::Shape::hex8:
    case simd::Shape::affine_hex8: return 8;
  }
  return 0;
}

std::uint32_t Unit::node_count() const noexcept { return nodes_of(shape, length); }

Units make_units(const Body& body) {
  const MeshView& mesh = body.mesh;
  if (mesh.type == ElementType::tet4) return cover_by_fans(body);
  Units result;
  result.nodes.assign(mesh.connectivity.begin(), mesh.connectivity.end());
  const auto nodes = static_cast<std::uint32_t>(nodes_per_element(mesh.type));
  for (std::uint32_t e = 0; e < mesh.element_count(); ++e) {
    simd::Shape shape = simd::Shape::hex8;
    if (mesh.type == ElementType::tri3) shape = simd::Shape::tri3;
    if (mesh.type == ElementType::hex8 && affine(mesh, &mesh.connectivity[std::size_t{e} * nodes]))
      shape = simd::Shape::affine_hex8;
    if (mesh.type == ElementType::tet10)
      shape = straight(mesh, &mesh.connectivity[std::size_t{e} * nodes]) ? simd::Shape::tet10
                                                                         : simd::Shape::curved_tet10;
    result.units.push_back({shape, 1, body.law_index(e), e * nodes, e});
    result.elements.push_back(static_cast<std::int32_t>(e));
  }
  return result;
}

}  // namespace kacanov
