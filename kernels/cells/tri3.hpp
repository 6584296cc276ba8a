// SPDX-License-Identifier: BSD-3-Clause
// Linear triangle: shape functions and its one quadrature point.
#pragma once

#include <array>

namespace kacanov::elements {

struct Tri3 {
  static constexpr int dim = 2, nodes = 3, points = 1;
  static constexpr std::array<std::array<double, 2>, 1> point{{{1.0 / 3.0, 1.0 / 3.0}}};
  static constexpr double weight = 0.5;  ///< of each point, on the reference element

  /// Shape functions at ξ.
  static constexpr std::array<double, 3> values(const double* xi) {
    return {1.0 - xi[0] - xi[1], xi[0], xi[1]};
  }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 6> gradients(const double*) { return {-1, -1, 1, 0, 0, 1}; }
};

}  // namespace kacanov::elements
