// SPDX-License-Identifier: BSD-3-Clause
// Points and lines: facets of 2D bodies, and other cells in mesh files.
#pragma once

#include "cells/tensor.hpp"

namespace kacanov::elements {

struct Point1 {
  static constexpr std::string_view name = "point", basix = "point";
  static constexpr int gmsh = 15, vtk = 1, dim = 0, order = 0, nodes = 1, corners = 1;
};

struct Line2 {
  static constexpr std::string_view name = "line2", basix = "interval";
  static constexpr int gmsh = 1, vtk = 3, dim = 1, order = 1, nodes = 2, corners = 2;
  static constexpr bool simplex = false;
  static constexpr std::array<std::array<int, 1>, 2> corner{{{-1}, {1}}};
  static constexpr std::array<CellEdge, 1> edge{{{0, 1}}};
  /// Shape functions at ξ.
  static constexpr std::array<double, 2> values(const double* xi) { return tensor_values<Line2>(xi); }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 2> gradients(const double* xi) { return tensor_gradients<Line2>(xi); }
  static constexpr auto node() { return tensor_points<Line2>(1.0); }
};

/// Boundary of flat pieces in files of quadratic tetrahedra; only its node count matters.
struct Line3 {
  static constexpr std::string_view name = "line3", basix = "interval";
  static constexpr int gmsh = 8, vtk = 21, dim = 1, order = 2, nodes = 3, corners = 2;
};

}  // namespace kacanov::elements
