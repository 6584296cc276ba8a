// SPDX-License-Identifier: BSD-3-Clause
// Hexahedra that are parallelepipeds: one Jacobian for all their points.
#pragma once

#include <array>
#include <cstddef>

#include "cells/elements.hpp"

namespace kacanov::elements {

/// Products of the derivatives of hex8's shape functions with respect to ξ.
namespace hex8_slopes {

/// Upper triangles, row by row, for all nodes.
using Products = std::array<std::array<double, 6>, 8>;
constexpr std::array<double, 6> product_of(const double* d) {
  return {d[0] * d[0], d[0] * d[1], d[0] * d[2], d[1] * d[1], d[1] * d[2], d[2] * d[2]};
}
inline constexpr std::array<Products, 8> of_point = [] {
  std::array<Products, 8> all{};
  for (std::size_t q = 0; q < 8; ++q) {
    const auto d = Hex8::gradients(Hex8::point[q].data());
    for (std::size_t a = 0; a < 8; ++a) all[q][a] = product_of(&d[3 * a]);
  }
  return all;
}();
inline constexpr Products of_all = [] {
  Products sum{};
  for (const Products& here : of_point)
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t k = 0; k < 6; ++k) sum[a][k] += here[a][k];
  return sum;
}();
/// Products of the averages over the points, times the number of points.
inline constexpr Products of_mean = [] {
  Products all{};
  for (std::size_t a = 0; a < 8; ++a) {
    double mean[3] = {};
    for (std::size_t q = 0; q < 8; ++q)
      for (std::size_t k = 0; k < 3; ++k) mean[k] += Hex8::gradients(Hex8::point[q].data())[3 * a + k] / 8.0;
    all[a] = product_of(mean);
    for (double& v : all[a]) v *= 8.0;
  }
  return all;
}();

}  // namespace hex8_slopes

struct Parallelepiped {
  double inverse[3][3];  ///< ∂ξ_k/∂x_i at [i][k]
  double volume;         ///< of a point

  explicit Parallelepiped(const double* x) {
    double side[3][3];  // ∂x_i/∂ξ_k at [k][i]
    for (std::size_t i = 0; i < 3; ++i) {
      side[0][i] = 0.5 * (x[3 * 1 + i] - x[i]);
      side[1][i] = 0.5 * (x[3 * 3 + i] - x[i]);
      side[2][i] = 0.5 * (x[3 * 4 + i] - x[i]);
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        inverse[i][k] = side[k1][i1] * side[k2][i2] - side[k1][i2] * side[k2][i1];
      }
    const double det = side[0][0] * inverse[0][0] + side[0][1] * inverse[1][0] + side[0][2] * inverse[2][0];
    const double scale = 1.0 / det;
    volume = det * Hex8::weight;
    for (auto& row : inverse)
      for (double& v : row) v *= scale;
  }

  /// Adds the sum of Point::add_diagonal_block() over points_of(), for all nodes; `g`: one value per point.
  void add_diagonal_blocks(double bulk, bool mean_dilatation, const std::array<double, 8>& g,
                           double (&block)[8][9]) const {
    for (std::size_t a = 0; a < 8; ++a) {
      // Σ g ∂N ∂Nᵀ in ξ, and the products that k0 multiplies.
      std::array<double, 6> shear{}, volumetric{};
      for (std::size_t q = 0; q < 8; ++q)
        for (std::size_t k = 0; k < 6; ++k) shear[k] += g[q] * hex8_slopes::of_point[q][a][k];
      const auto& seen = mean_dilatation ? hex8_slopes::of_mean : hex8_slopes::of_all;
      for (std::size_t k = 0; k < 6; ++k) volumetric[k] = bulk * seen[a][k] + shear[k] * (1.0 / 3.0);
      const auto s = in_space(shear), v = in_space(volumetric);
      const double even = s[0] + s[3] + s[5];
      const double rows[9] = {v[0] + even, v[1], v[2], v[1], v[3] + even, v[4], v[2], v[4], v[5] + even};
      for (std::size_t k = 0; k < 9; ++k) block[a][k] += rows[k];
    }
  }

 private:
  /// Returns volume times inverse m inverseᵀ.
  std::array<double, 6> in_space(const std::array<double, 6>& m) const {
    double half[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double* t = inverse[i];
      half[i][0] = t[0] * m[0] + t[1] * m[1] + t[2] * m[2];
      half[i][1] = t[0] * m[1] + t[1] * m[3] + t[2] * m[4];
      half[i][2] = t[0] * m[2] + t[1] * m[4] + t[2] * m[5];
    }
    std::array<double, 6> out;
    for (std::size_t i = 0, k = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j, ++k)
        out[k] =
            volume * (half[i][0] * inverse[j][0] + half[i][1] * inverse[j][1] + half[i][2] * inverse[j][2]);
    return out;
  }
};

}  // namespace kacanov::elements
