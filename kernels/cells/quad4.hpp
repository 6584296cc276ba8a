// SPDX-License-Identifier: BSD-3-Clause
// Bilinear quadrilateral with the 2×2 Gauss points: plane strain, and the facet of hex8.
#pragma once

#include "cells/line.hpp"

namespace kacanov::elements {

struct Quad4 {
  static constexpr ElementType type = ElementType::quad4;
  static constexpr std::string_view name = "quad4", abaqus = "CPE4", basix = "quadrilateral";
  static constexpr int gmsh = 3, vtk = 9, dim = 2, order = 1, nodes = 4, corners = 4, points = 4;
  static constexpr bool simplex = false, mean_dilatation = true, corner_dilatation = false;
  static constexpr std::array<std::array<int, 2>, 4> corner{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  static constexpr std::array<CellEdge, 4> edge{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static constexpr std::array<std::int8_t, 4> basix_order{0, 1, 3, 2};
  static constexpr std::array<Triple, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  using Facet = Line2;
  static constexpr std::array<std::array<std::int8_t, 2>, 4> facet{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static constexpr double weight = 1.0;  ///< of each point
  /// Point i lies next to corner i.
  static constexpr std::array<std::array<double, 2>, 4> point{
      {{-gauss2, -gauss2}, {gauss2, -gauss2}, {gauss2, gauss2}, {-gauss2, gauss2}}};
  /// Shape functions at ξ.
  static constexpr std::array<double, 4> values(const double* xi) { return tensor_values<Quad4>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 8> gradients(const double* xi) { return tensor_gradients<Quad4>(xi); }
  static constexpr auto node() { return tensor_points<Quad4>(1.0); }
  static constexpr auto box() { return whole_box<Quad4>(); }
};

}  // namespace kacanov::elements
