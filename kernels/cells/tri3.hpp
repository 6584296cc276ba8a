// SPDX-License-Identifier: BSD-3-Clause
// Linear triangle with its one quadrature point: plane strain, and the facet of tet4.
#pragma once

#include "cells/line.hpp"

namespace kacanov::elements {

struct Tri3 {
  static constexpr ElementType type = ElementType::tri3;
  static constexpr std::string_view name = "tri3", abaqus = "CPE3", basix = "triangle";
  static constexpr int gmsh = 2, vtk = 5, dim = 2, order = 1, nodes = 3, corners = 3, points = 1;
  static constexpr bool simplex = true, mean_dilatation = false, corner_dilatation = false;
  static constexpr std::array<CellEdge, 3> edge{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<Triple, 1> triangles{{{0, 1, 2}}};
  using Facet = Line2;
  static constexpr std::array<std::array<std::int8_t, 2>, 3> facet{{{0, 1}, {1, 2}, {2, 0}}};
  static constexpr std::array<std::array<double, 2>, 1> point{{{1.0 / 3.0, 1.0 / 3.0}}};
  static constexpr double weight = 0.5;  ///< of each point, on the reference element
  /// The square, split from lower left to upper right.
  static constexpr std::array<Triple, 6> box() { return {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}}; }

  /// Shape functions at ξ.
  static constexpr std::array<double, 3> values(const double* xi) { return barycentric<2>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 6> gradients(const double*) { return barycentric_slopes<2>(); }
  static constexpr auto node() { return simplex_nodes<Tri3>(); }
};

}  // namespace kacanov::elements
