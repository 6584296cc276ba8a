// SPDX-License-Identifier: BSD-3-Clause
// Quadratic tetrahedron with the four-point rule of degree 2.
#pragma once

#include "cells/tet4.hpp"
#include "cells/tri6.hpp"

namespace kacanov::elements {

struct Tet10 {
  static constexpr ElementType type = ElementType::tet10;
  static constexpr std::string_view name = "tet10", abaqus = "C3D10", basix = "tetrahedron";
  static constexpr int gmsh = 11, vtk = 24, dim = 3, order = 2, nodes = 10, corners = 4, points = 4;
  static constexpr bool simplex = true, mean_dilatation = false, corner_dilatation = true;
  static constexpr std::array<CellEdge, 6> edge{
      {{0, 1, 4}, {1, 2, 5}, {2, 0, 6}, {3, 0, 7}, {3, 2, 8}, {3, 1, 9}}};
  /// VTK swaps the midpoints of the edges 13 and 23.
  static constexpr std::array<std::int8_t, 10> vtk_order{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  static constexpr std::array<std::int8_t, 10> basix_order{0, 1, 2, 3, 8, 9, 5, 7, 6, 4};
  using Facet = Tri6;
  static constexpr std::array<std::array<std::int8_t, 6>, 4> facet{
      {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {0, 3, 2, 7, 8, 6}, {1, 2, 3, 5, 8, 9}}};
  static constexpr double far = 0.13819660112501052;   ///< (5 − √5)/20
  static constexpr double near = 0.58541019662496845;  ///< (5 + 3√5)/20
  /// Point i lies next to vertex i: barycentric coordinate `near` there, `far` at the others.
  static constexpr std::array<std::array<double, 3>, 4> point{
      {{far, far, far}, {near, far, far}, {far, near, far}, {far, far, near}}};
  static constexpr double weight = 1.0 / 24.0;  ///< of each point, on the reference element
  static constexpr auto box() { return six_tetrahedra; }

  /// Shape functions at ξ.
  static constexpr std::array<double, 10> values(const double* xi) { return quadratic_values<Tet10>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 30> gradients(const double* xi) {
    return quadratic_gradients<Tet10>(xi);
  }
  static constexpr auto node() { return simplex_nodes<Tet10>(); }
};

}  // namespace kacanov::elements
