// SPDX-License-Identifier: BSD-3-Clause
// Quadratic tetrahedron in Gmsh's node order: shape functions and the four-point rule of degree 2.
#pragma once

#include <array>
#include <cstddef>

namespace kacanov::elements {

struct Tet10 {
  static constexpr int dim = 3, nodes = 10, points = 4;
  static constexpr double far = 0.13819660112501052;   ///< (5 − √5)/20
  static constexpr double near = 0.58541019662496845;  ///< (5 + 3√5)/20
  /// Point i lies next to vertex i: barycentric coordinate `near` there, `far` at the others.
  static constexpr std::array<std::array<double, 3>, 4> point{
      {{far, far, far}, {near, far, far}, {far, near, far}, {far, far, near}}};
  static constexpr double weight = 1.0 / 24.0;  ///< of each point, on the reference element
  /// The vertices that mid-side nodes 4 to 9 lie between.
  static constexpr std::array<std::array<int, 2>, 6> edge{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};

  /// Shape functions at ξ.
  static constexpr std::array<double, 10> values(const double* xi) {
    const std::array<double, 4> l{1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
    std::array<double, 10> n{};
    for (std::size_t a = 0; a < 4; ++a) n[a] = l[a] * (2.0 * l[a] - 1.0);
    for (std::size_t e = 0; e < 6; ++e)
      n[4 + e] = 4.0 * l[static_cast<std::size_t>(edge[e][0])] * l[static_cast<std::size_t>(edge[e][1])];
    return n;
  }
  /// ∂N/∂ξ at ξ, nodes × dim.
  static constexpr std::array<double, 30> gradients(const double* xi) {
    const std::array<double, 4> l{1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
    constexpr std::array<std::array<double, 3>, 4> dl{{{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::array<double, 30> d{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t a = 0; a < 4; ++a) d[3 * a + k] = (4.0 * l[a] - 1.0) * dl[a][k];
      for (std::size_t e = 0; e < 6; ++e) {
        const auto a = static_cast<std::size_t>(edge[e][0]), b = static_cast<std::size_t>(edge[e][1]);
        d[3 * (4 + e) + k] = 4.0 * (l[a] * dl[b][k] + l[b] * dl[a][k]);
      }
    }
    return d;
  }
};

}  // namespace kacanov::elements
