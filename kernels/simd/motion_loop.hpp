// SPDX-License-Identifier: BSD-3-Clause
// Products of strains and stresses of rigid motions, with one vector for all motions of an aggregate.
// Included once per instruction set, with its compiler flags.
#pragma once

#include <cmath>

#include "simd/motion_products.hpp"

namespace kacanov::simd {
namespace {

constexpr std::size_t most_nodes = 10;

/// GCC vectors: the compiler splits them into registers of the target.
template <int M>
struct Motions {
  using Vector [[gnu::vector_size(motion_lanes<M> * sizeof(double))]] = double;
};

template <int M>
void add_products(const MotionPoint<M>& point, const MotionPair* pairs, std::size_t count) {
  using Vector = typename Motions<M>::Vector;
  constexpr std::size_t dim = MotionPoint<M>::dim;
  // Strains xx, yy, zz, √2 xy, √2 yz, √2 zx, so that dot products equal tensor products (zz is zero in 2D
  // unless the body is axisymmetric), and the dilatation that k0 acts on.
  Vector strain[most_nodes][7], stress[most_nodes][7];
  for (std::size_t k = 0; k < point.groups; ++k)
    for (std::size_t c = 0; c < 7; ++c) strain[k][c] = Vector{};
  for (std::size_t a = 0; a < point.nodes; ++a) {
    const double *d = point.gradient + a * dim, *mean = point.dilatation + a * dim;
    Vector* s = strain[point.group[a]];
    Vector z[dim];
    for (std::size_t c = 0; c < dim; ++c) {
      z[c] = *reinterpret_cast<const Vector*>(point.rows[a].row[c]);
      s[c] += d[c] * z[c];
      s[6] += mean[c] * z[c];
    }
    s[3] += d[0] * z[1] + d[1] * z[0];
    if constexpr (dim == 2)
      if (point.hoop != nullptr) s[2] += point.hoop[a] * z[0];
    if constexpr (dim == 3) {
      s[4] += d[1] * z[2] + d[2] * z[1];
      s[5] += d[2] * z[0] + d[0] * z[2];
    }
  }
  const double root = std::sqrt(0.5);
  for (std::size_t k = 0; k < point.groups; ++k) {
    Vector *e = strain[k], *s = stress[k];
    const Vector mean = (e[0] + e[1] + e[2]) * (1.0 / 3.0);
    for (std::size_t c = 0; c < 3; ++c) s[c] = point.shear * (e[c] - mean);
    for (std::size_t c = 3; c < 6; ++c) {
      e[c] *= root;
      s[c] = point.shear * e[c];
    }
    s[6] = point.bulk * e[6];
  }
  for (const MotionPair* p = pairs; p != pairs + count; ++p) {
    Vector sum[M] = {};
    for (std::size_t c = 0; c < 7; ++c) {
      const Vector t = stress[p->b][c];
#pragma GCC unroll 8
      for (std::size_t i = 0; i < M; ++i) sum[i] += strain[p->a][c][i] * t;
    }
    for (std::size_t i = 0; i < M; ++i)
      for (std::size_t j = 0; j < M; ++j) p->sum[i * M + j] += sum[i][j];
  }
}

}  // namespace
}  // namespace kacanov::simd
