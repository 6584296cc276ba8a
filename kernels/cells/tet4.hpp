// SPDX-License-Identifier: BSD-3-Clause
// Linear tetrahedron with its one quadrature point.
#pragma once

#include <utility>

#include "cells/tri3.hpp"

namespace kacanov::elements {

/// The cube as six tetrahedra around its diagonal from the lowest to the highest corner, one per path along
/// the axes between these corners; for odd permutations two corners are swapped to keep the orientation.
inline constexpr std::array<Triple, 24> six_tetrahedra = [] {
  constexpr std::size_t path[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::array<Triple, 24> corners{};
  for (std::size_t p = 0; p < 6; ++p) {
    Triple* corner = corners.data() + 4 * p;
    for (std::size_t s = 0; s < 3; ++s) {
      corner[s + 1] = corner[s];
      corner[s + 1][path[p][s]] = 1;
    }
    if (p >= 3) std::swap(corner[2], corner[3]);
  }
  return corners;
}();

struct Tet4 {
  static constexpr ElementType type = ElementType::tet4;
  static constexpr std::string_view name = "tet4", abaqus = "C3D4", basix = "tetrahedron";
  static constexpr int gmsh = 4, vtk = 10, dim = 3, order = 1, nodes = 4, corners = 4, points = 1;
  static constexpr bool simplex = true, mean_dilatation = false, corner_dilatation = true;
  static constexpr std::array<CellEdge, 6> edge{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
  using Facet = Tri3;
  static constexpr std::array<std::array<std::int8_t, 3>, 4> facet{
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  static constexpr std::array<std::array<double, 3>, 1> point{{{0.25, 0.25, 0.25}}};
  static constexpr double weight = 1.0 / 6.0;  ///< of each point, on the reference element
  static constexpr auto box() { return six_tetrahedra; }

  /// Shape functions at ξ.
  static constexpr std::array<double, 4> values(const double* xi) { return barycentric<3>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 12> gradients(const double*) { return barycentric_slopes<3>(); }
  static constexpr auto node() { return simplex_nodes<Tet4>(); }
};

}  // namespace kacanov::elements
