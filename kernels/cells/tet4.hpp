// SPDX-License-Identifier: BSD-3-Clause
// Linear tetrahedron: shape functions and its one quadrature point.
#pragma once

#include <array>

namespace kacanov::elements {

struct Tet4 {
  static constexpr int dim = 3, nodes = 4, points = 1;
  static constexpr std::array<std::array<double, 3>, 1> point{{{0.25, 0.25, 0.25}}};
  static constexpr double weight = 1.0 / 6.0;  ///< of each point, on the reference element

  /// Shape functions at ξ.
  static constexpr std::array<double, 4> values(const double* xi) {
    return {1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
  }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 12> gradients(const double*) {
    return {-1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  }
};

}  // namespace kacanov::elements
