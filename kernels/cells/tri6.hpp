// SPDX-License-Identifier: BSD-3-Clause
// Quadratic triangle: the facet of tet10.
#pragma once

#include "cells/tri3.hpp"

namespace kacanov::elements {

struct Tri6 {
  static constexpr std::string_view name = "tri6", basix = "triangle";
  static constexpr int gmsh = 9, vtk = 22, dim = 2, order = 2, nodes = 6, corners = 3;
  static constexpr bool simplex = true;
  static constexpr std::array<CellEdge, 3> edge{{{0, 1, 3}, {1, 2, 4}, {2, 0, 5}}};
  static constexpr std::array<std::int8_t, 6> basix_order{0, 1, 2, 4, 5, 3};
  static constexpr std::array<Triple, 4> triangles{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  /// Shape functions at ξ.
  static constexpr std::array<double, 6> values(const double* xi) { return quadratic_values<Tri6>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 12> gradients(const double* xi) {
    return quadratic_gradients<Tri6>(xi);
  }
  static constexpr auto node() { return simplex_nodes<Tri6>(); }
};

}  // namespace kacanov::elements
