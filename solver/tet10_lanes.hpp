// SPDX-License-Identifier: BSD-3-Clause
// Quadratic tetrahedra abreast: position and displacement gradient anywhere in them.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "cells/tet10.hpp"
#include "lanes.hpp"

namespace kacanov::tet10 {

/// From values at the nodes to coefficients of 1, ξ, η, ζ, ξ², η², ζ², ξη, ηζ, ζξ.
inline void to_monomials(Lanes (&v)[10][3]) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      const double v0 = v[0][i][lane], v1 = v[1][i][lane], v2 = v[2][i][lane], v3 = v[3][i][lane],
                   m01 = v[4][i][lane], m12 = v[5][i][lane], m02 = v[6][i][lane], m03 = v[7][i][lane],
                   m23 = v[8][i][lane], m13 = v[9][i][lane];
      // Slopes and bends of the three edges from corner 0.
      const double s1 = 4.0 * (m01 - v0) - (v1 - v0), s2 = 4.0 * (m02 - v0) - (v2 - v0),
                   s3 = 4.0 * (m03 - v0) - (v3 - v0);
      v[1][i][lane] = s1;
      v[2][i][lane] = s2;
      v[3][i][lane] = s3;
      v[4][i][lane] = 2.0 * ((v0 - m01) + (v1 - m01));
      v[5][i][lane] = 2.0 * ((v0 - m02) + (v2 - m02));
      v[6][i][lane] = 2.0 * ((v0 - m03) + (v3 - m03));
      v[7][i][lane] = 4.0 * ((m12 - m01) - (m02 - v0));
      v[8][i][lane] = 4.0 * ((m23 - m02) - (m03 - v0));
      v[9][i][lane] = 4.0 * ((m13 - m01) - (m03 - v0));
    }
}

/// Tetrahedra abreast, straight or curved, as polynomials of their reference coordinates.
struct Tetrahedra {
  using Element = elements::Tet10;

  Lanes x[10][3], moved[10][3];  ///< coefficients as to_monomials() has them

  void gather(const MeshView& mesh, std::span<const double> u, const ElementsAbreast& element) {
    kacanov::gather(mesh, element, mesh.coordinates, x);
    kacanov::gather(mesh, element, u, moved);
    to_monomials(x);
    to_monomials(moved);
  }

  /// At the reference coordinates `xi`.
  void gradient(const std::array<double, 3>& xi, GradientLanes& out) const {
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      double j[3][3], d[3][3], h[3][3];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          j[i][k] = along(x, i, k, xi, lane);
          d[i][k] = along(moved, i, k, xi, lane);
        }
      out.det[lane] = map_gradient(j, d, h);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) out.h[i][k][lane] = h[i][k];
    }
  }

  /// From ξ = 0, the first corner, which x[0] has.
  void from_base(const std::array<double, 3>& xi, Lanes (&out)[3]) const {
    const double a = xi[0], b = xi[1], c = xi[2];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t lane = 0; lane < abreast; ++lane)
        out[i][lane] = a * x[1][i][lane] + b * x[2][i][lane] + c * x[3][i][lane] + a * a * x[4][i][lane] +
                       b * b * x[5][i][lane] + c * c * x[6][i][lane] + a * b * x[7][i][lane] +
                       b * c * x[8][i][lane] + c * a * x[9][i][lane];
  }

 private:
  /// Derivative of component i along ξ_k.
  static double along(const Lanes (&v)[10][3], std::size_t i, std::size_t k, const std::array<double, 3>& xi,
                      std::size_t lane) {
    const std::size_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    return v[1 + k][i][lane] + 2.0 * xi[k] * v[4 + k][i][lane] + xi[k1] * v[7 + k][i][lane] +
           xi[k2] * v[7 + k2][i][lane];
  }
};

}  // namespace kacanov::tet10
