// SPDX-License-Identifier: BSD-3-Clause
// Tetrahedra with straight edges: one Jacobian for all their points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cells/elements.hpp"
#include "cells/point.hpp"

namespace kacanov::elements {

/// Returns whether the mid-side nodes are the midpoints of their edges, up to rounding of the edge and of the
/// coordinates. Computed from differences, which are exact.
inline bool has_straight_sides(const Nodal<Tet10>& x) {
  for (const CellEdge& edge : Tet10::edge) {
    double off = 0.0, side = 0.0, far = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double a = x[Point<Tet10>::at(edge.a, k)], b = x[Point<Tet10>::at(edge.b, k)];
      const double middle = x[Point<Tet10>::at(edge.middle, k)];
      off = std::max(off, 0.5 * std::abs((middle - a) - (b - middle)));
      side = std::max(side, std::abs(a - b));
      far = std::max({far, std::abs(a), std::abs(b)});
    }
    if (off > 1e-13 * side + std::numeric_limits<double>::epsilon() * far) return false;
  }
  return true;
}
inline bool has_straight_sides(const Nodal<Tet4>&) { return true; }

/// Shape functions of the corners: linear for tetrahedra; a hexahedron has one constant for all corners.
template <class E>
std::array<double, E::corners> corner_shares(const double* xi) {
  if constexpr (E::simplex) {
    return barycentric<E::dim>(xi);
  } else {
    std::array<double, E::corners> even;
    even.fill(1.0 / E::corners);
    return even;
  }
}

/// ∇L of the corners, and the volume.
struct StraightSides {
  double gradient[4][3];
  double volume;

  /// Reads only the corners of the element's nodes.
  explicit StraightSides(const double* x) {
    double side[3][3];
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) side[k][i] = x[3 * (k + 1) + i] - x[i];
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        gradient[k + 1][i] = side[k1][i1] * side[k2][i2] - side[k1][i2] * side[k2][i1];
      }
    const double det =
        side[0][0] * gradient[1][0] + side[0][1] * gradient[1][1] + side[0][2] * gradient[1][2];
    const double scale = 1.0 / det;
    volume = det / 6.0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 1; k < 4; ++k) gradient[k][i] *= scale;
      gradient[0][i] = -(gradient[1][i] + gradient[2][i] + gradient[3][i]);
    }
  }

  /// ∫ L_c ∂_k N_a.
  void integrate(std::array<std::array<std::array<double, 3>, 4>, 4>& of) const {
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 3; ++k) of[a][c][k] = 0.25 * volume * gradient[a][k];
  }
  void integrate(std::array<std::array<std::array<double, 3>, 4>, 10>& of) const {
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 3; ++k) of[a][c][k] = (a == c ? 0.15 : -0.05) * volume * gradient[a][k];
    for (const CellEdge& edge : Tet10::edge) {
      const auto a = static_cast<std::size_t>(edge.a), b = static_cast<std::size_t>(edge.b);
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 3; ++k)
          of[static_cast<std::size_t>(edge.middle)][c][k] =
              volume * ((a == c ? 0.4 : 0.2) * gradient[b][k] + (b == c ? 0.4 : 0.2) * gradient[a][k]);
    }
  }

  /// Adds the sum of Point::add_diagonal_block() over the points, for all nodes; `g`: one value per point.
  void add_diagonal_blocks(double bulk, const std::array<double, 1>& g, double (&block)[4][9]) const {
    const double shear = volume * g[0], volumetric = volume * bulk + shear * (1.0 / 3.0);
    for (std::size_t a = 0; a < 4; ++a) {
      const double* d = gradient[a];
      const double even = shear * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          block[a][3 * i + j] += volumetric * d[i] * d[j] + (i == j ? even : 0.0);
    }
  }
  void add_diagonal_blocks(double bulk, const std::array<double, 4>& g, double (&block)[10][9]) const {
    constexpr double far = Tet10::far, near = Tet10::near;
    // Sums over the points of f L_a L_b with f = 1 or g: L_a is `near` at its own point, `far` at the others.
    constexpr double both = far * far, one = far * (near - far), square = near * near - far * far;
    const double v = 0.25 * volume, sum = g[0] + g[1] + g[2] + g[3];
    for (std::size_t a = 0; a < 4; ++a) {  // ∇N = (4 L_a − 1) ∇L_a
      constexpr double at_near = (4.0 * near - 1.0) * (4.0 * near - 1.0);
      constexpr double at_far = (4.0 * far - 1.0) * (4.0 * far - 1.0);
      const double shear = v * (at_far * (sum - g[a]) + at_near * g[a]);
      const double volumetric = v * bulk * (3.0 * at_far + at_near) + shear * (1.0 / 3.0);
      const double* d = gradient[a];
      const double even = shear * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          block[a][3 * i + j] += volumetric * d[i] * d[j] + (i == j ? even : 0.0);
    }
    const double bulk_same = v * bulk * (4.0 * both + square),
                 bulk_other = v * bulk * (4.0 * both + 2.0 * one);
    for (const CellEdge& edge : Tet10::edge) {  // ∇N = 4 (L_a ∇L_b + L_b ∇L_a)
      const auto a = static_cast<std::size_t>(edge.a), b = static_cast<std::size_t>(edge.b);
      const double *da = gradient[a], *db = gradient[b];
      const double bb = v * (both * sum + square * g[a]), aa = v * (both * sum + square * g[b]);
      const double ab = v * (both * sum + one * (g[a] + g[b]));
      const double even = 16.0 * (aa * (da[0] * da[0] + da[1] * da[1] + da[2] * da[2]) +
                                  bb * (db[0] * db[0] + db[1] * db[1] + db[2] * db[2]) +
                                  2.0 * ab * (da[0] * db[0] + da[1] * db[1] + da[2] * db[2]));
      const double waa = 16.0 * (bulk_same + aa * (1.0 / 3.0)), wbb = 16.0 * (bulk_same + bb * (1.0 / 3.0)),
                   wab = 16.0 * (bulk_other + ab * (1.0 / 3.0));
      double* to = block[edge.middle];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          to[3 * i + j] += waa * da[i] * da[j] + wbb * db[i] * db[j] + wab * (da[i] * db[j] + db[i] * da[j]) +
                           (i == j ? even : 0.0);
    }
  }
};

/// Element integrals ∫ L_c ∂_k N_a and ∫ L_c with the corners' linear functions L.
template <class E>
struct CornerIntegrals {
  std::array<std::array<std::array<double, 3>, E::corners>, E::nodes> change{};
  std::array<double, E::corners> volume{};
};

template <class E>
CornerIntegrals<E> corner_integrals(const Nodal<E>& x) {
  CornerIntegrals<E> of;
  if constexpr (E::simplex)
    if (has_straight_sides(x)) {
      const StraightSides sides(x.data());
      sides.integrate(of.change);
      of.volume.fill(sides.volume / E::corners);
      return of;
    }
  for (std::size_t q = 0; q < E::points; ++q) {
    const Point<E> point(x, q);
    const auto share = corner_shares<E>(E::point[q].data());
    for (std::size_t c = 0; c < E::corners; ++c) of.volume[c] += point.volume * share[c];
    for (std::size_t a = 0; a < E::nodes; ++a)
      for (std::size_t c = 0; c < E::corners; ++c)
        for (std::size_t k = 0; k < 3; ++k)
          of.change[a][c][k] += point.volume * share[c] * point.gradient[a][k];
  }
  return of;
}

}  // namespace kacanov::elements
