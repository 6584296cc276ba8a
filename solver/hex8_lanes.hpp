// SPDX-License-Identifier: BSD-3-Clause
// Trilinear hexahedra abreast: position, displacement gradient and strain anywhere in them.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "cells/hex8.hpp"
#include "lanes.hpp"

namespace kacanov::hex8 {

/// From values at the corners to coefficients of 1, ξ, η, ζ, ξη, ηζ, ζξ, ξηζ.
template <std::size_t n>
void to_monomials(Lanes (&v)[8][n]) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      const double v0 = v[0][i][lane], v1 = v[1][i][lane], v2 = v[2][i][lane], v3 = v[3][i][lane],
                   v4 = v[4][i][lane], v5 = v[5][i][lane], v6 = v[6][i][lane], v7 = v[7][i][lane];
      // Sums and differences along ξ at (η, ζ) = (−, −), (+, −), (−, +), (+, +); along η; then along ζ.
      const double s0 = v0 + v1, s1 = v3 + v2, s2 = v4 + v5, s3 = v7 + v6;
      const double d0 = v1 - v0, d1 = v2 - v3, d2 = v5 - v4, d3 = v6 - v7;
      const double ss0 = s0 + s1, ss1 = s2 + s3, sd0 = s1 - s0, sd1 = s3 - s2;
      const double ds0 = d0 + d1, ds1 = d2 + d3, dd0 = d1 - d0, dd1 = d3 - d2;
      v[0][i][lane] = 0.125 * (ss0 + ss1);
      v[1][i][lane] = 0.125 * (ds0 + ds1);
      v[2][i][lane] = 0.125 * (sd0 + sd1);
      v[3][i][lane] = 0.125 * (ss1 - ss0);
      v[4][i][lane] = 0.125 * (dd0 + dd1);
      v[5][i][lane] = 0.125 * (sd1 - sd0);
      v[6][i][lane] = 0.125 * (ds1 - ds0);
      v[7][i][lane] = 0.125 * (dd1 - dd0);
    }
}

/// Hexahedra abreast, as polynomials of their reference coordinates.
struct Hexahedra {
  using Element = elements::Hex8;

  Lanes x[8][3], moved[8][3];  ///< coefficients as to_monomials() has them

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

  /// From ξ = 0, the middle, which x[0] has.
  void from_base(const std::array<double, 3>& xi, Lanes (&out)[3]) const {
    const double a = xi[0], b = xi[1], c = xi[2];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t lane = 0; lane < abreast; ++lane)
        out[i][lane] = a * x[1][i][lane] + b * x[2][i][lane] + c * x[3][i][lane] + a * b * x[4][i][lane] +
                       b * c * x[5][i][lane] + c * a * x[6][i][lane] + a * b * c * x[7][i][lane];
  }

 private:
  /// Derivative of component i along ξ_k.
  static double along(const Lanes (&v)[8][3], std::size_t i, std::size_t k, const std::array<double, 3>& xi,
                      std::size_t lane) {
    const std::size_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    return v[1 + k][i][lane] + xi[k1] * v[4 + k][i][lane] + xi[k2] * v[4 + k2][i][lane] +
           xi[k1] * xi[k2] * v[7][i][lane];
  }
};

}  // namespace kacanov::hex8
