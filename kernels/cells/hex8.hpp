// SPDX-License-Identifier: BSD-3-Clause
// Trilinear hexahedron: shape functions and the 2×2×2 Gauss points.
#pragma once

#include <array>
#include <cstddef>

namespace kacanov::elements {

struct Hex8 {
  static constexpr int dim = 3, nodes = 8, points = 8;
  /// Corners of the reference element [-1, 1]³ in node order.
  static constexpr std::array<std::array<int, 3>, 8> corner{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  static constexpr double gauss = 0.57735026918962576;  ///< 1/√3
  static constexpr double weight = 1.0;                 ///< of each point
  /// Point i lies next to corner i.
  static constexpr std::array<std::array<double, 3>, 8> point = [] {
    std::array<std::array<double, 3>, 8> p{};
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t k = 0; k < 3; ++k) p[i][k] = gauss * corner[i][k];
    return p;
  }();

  /// Shape functions at ξ.
  static constexpr std::array<double, 8> values(const double* xi) {
    std::array<double, 8> n{};
    for (std::size_t a = 0; a < 8; ++a)
      n[a] = 0.125 * (1 + corner[a][0] * xi[0]) * (1 + corner[a][1] * xi[1]) * (1 + corner[a][2] * xi[2]);
    return n;
  }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 24> gradients(const double* xi) {
    std::array<double, 24> d{};
    for (std::size_t a = 0; a < 8; ++a) {
      const double x = 1 + corner[a][0] * xi[0], y = 1 + corner[a][1] * xi[1], z = 1 + corner[a][2] * xi[2];
      d[3 * a] = 0.125 * corner[a][0] * y * z;
      d[3 * a + 1] = 0.125 * corner[a][1] * x * z;
      d[3 * a + 2] = 0.125 * corner[a][2] * x * y;
    }
    return d;
  }
};

}  // namespace kacanov::elements
