// SPDX-License-Identifier: BSD-3-Clause
// Trilinear hexahedron with the 2×2×2 Gauss points.
#pragma once

#include "cells/quad4.hpp"

namespace kacanov::elements {

struct Hex8 {
  static constexpr ElementType type = ElementType::hex8;
  static constexpr std::string_view name = "hex8", abaqus = "C3D8", basix = "hexahedron";
  static constexpr int gmsh = 5, vtk = 12, dim = 3, order = 1, nodes = 8, corners = 8, points = 8;
  static constexpr bool simplex = false, mean_dilatation = true, corner_dilatation = false;
  /// Corners of the reference element [-1, 1]³ in node order.
  static constexpr std::array<std::array<int, 3>, 8> corner{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  static constexpr std::array<CellEdge, 12> edge{
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  static constexpr std::array<std::int8_t, 8> basix_order{0, 1, 3, 2, 4, 5, 7, 6};
  using Facet = Quad4;
  static constexpr std::array<std::array<std::int8_t, 4>, 6> facet{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}}};
  static constexpr double gauss = gauss2;
  static constexpr double weight = 1.0;  ///< of each point
  /// Point i lies next to corner i.
  static constexpr auto point = [] {
    std::array<std::array<double, 3>, 8> p{};
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t k = 0; k < 3; ++k) p[i][k] = gauss * corner[i][k];
    return p;
  }();

  /// Shape functions at ξ.
  static constexpr std::array<double, 8> values(const double* xi) { return tensor_values<Hex8>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 24> gradients(const double* xi) { return tensor_gradients<Hex8>(xi); }
  static constexpr auto node() { return tensor_points<Hex8>(1.0); }
  static constexpr auto box() { return whole_box<Hex8>(); }
};

}  // namespace kacanov::elements
