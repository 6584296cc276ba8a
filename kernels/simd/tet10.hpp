// SPDX-License-Identifier: BSD-3-Clause
// Quadratic tetrahedra with straight sides, one a lane: their strain is linear, given by its vertex values.
#pragma once

#include "elements/tet10.hpp"
#include "fan.hpp"

namespace {

/// The mid-side node between vertices i and j. A table: the compiler folds its entries where it would not run
/// a search.
struct TetMiddles {
  int between[4][4];
};

constexpr TetMiddles tet_middles = [] {
  TetMiddles table{};
  for (int m = 0; m < 6; ++m) {
    const auto& edge = kacanov::elements::Tet10::edge[static_cast<std::size_t>(m)];
    table.between[edge[0]][edge[1]] = table.between[edge[1]][edge[0]] = 4 + m;
  }
  return table;
}();

/// From values at the four vertices to those at the four points, in place. Symmetric: it serves stresses too.
template <class Real, int count, class V>
KACANOV_INLINE inline void tet_interpolate(V (&v)[4][count]) {
  constexpr Real far = Real(kacanov::elements::Tet10::far);
  constexpr Real rest = Real(kacanov::elements::Tet10::near - kacanov::elements::Tet10::far);
  for (int k = 0; k < count; ++k) {
    const V sum = far * ((v[0][k] + v[1][k]) + (v[2][k] + v[3][k]));
    for (int q = 0; q < 4; ++q) v[q][k] = rest * v[q][k] + sum;
  }
}

/// ∂u/∂λ_i at vertex j is 4 u_ij − u_i, and 3 u_i for i = j.
template <class L, class Real, class Material>
inline void tet10_loop(const Block<Real>& block, const Group& group, const Material& material, const Real* u,
                       Real* f, int vectors, std::size_t stride) {
  using V = typename L::V;
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    V x[4][3], c[3][3];  // c: det ∇λ_{k+1}
    for (int a = 0; a < 4; ++a) L::load3(block.coordinates, at + a * L::width, x[a]);
    for (int a = 1; a < 4; ++a)
      for (int k = 0; k < 3; ++k) x[a][k] -= x[0][k];
    cross(x[2], x[3], c[0]);
    cross(x[3], x[1], c[1]);
    cross(x[1], x[2], c[2]);
    const V det = inner(x[1], c[0]), w = Real(1.0 / 24.0) / det;
    for (int v = 0; v < vectors; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * stride;
      V d[10][3], h[4][9], s[4][6];
      for (int a = 0; a < 10; ++a) L::load3(u + offset, at + a * L::width, d[a]);
      for (int m = 4; m < 10; ++m)
        for (int k = 0; k < 3; ++k) d[m][k] *= Real(4);
#pragma GCC unroll 4
      for (int j = 0; j < 4; ++j) {
        V r[3][3];  // ∂u/∂λ_{i+1} − ∂u/∂λ_0 at vertex j
        for (int i = 1; i < 4; ++i)
          for (int k = 0; k < 3; ++k) {
            const V own = i == j ? Real(3) * d[i][k] : d[tet_middles.between[i][j]][k] - d[i][k];
            const V base = j == 0 ? Real(3) * d[0][k] : d[tet_middles.between[0][j]][k] - d[0][k];
            r[i - 1][k] = own - base;
          }
        for (int i = 0; i < 3; ++i)
          for (int m = 0; m < 3; ++m)
            h[j][3 * i + m] = r[0][i] * c[0][m] + r[1][i] * c[1][m] + r[2][i] * c[2][m];
      }
      tet_interpolate<Real>(h);
      for (int q = 0; q < 4; ++q) {
        const Sym<V> t = material.stress(h[q], det, w, Real(1.0 / 24.0), point + static_cast<std::size_t>(q));
        s[q][0] = t.xx, s[q][1] = t.yy, s[q][2] = t.zz, s[q][3] = t.xy, s[q][4] = t.yz, s[q][5] = t.zx;
      }
      tet_interpolate<Real>(s);
      V force[10][3] = {};
#pragma GCC unroll 4
      for (int j = 0; j < 4; ++j) {
        const Sym<V> stress{s[j][0], s[j][1], s[j][2], s[j][3], s[j][4], s[j][5]};
        V t[4][3];
        for (int i = 1; i < 4; ++i) multiply(stress, c[i - 1], t[i]);
        for (int k = 0; k < 3; ++k) t[0][k] = -(t[1][k] + t[2][k] + t[3][k]);
        for (int i = 0; i < 4; ++i)
          for (int k = 0; k < 3; ++k) {
            if (i == j) {
              force[i][k] += Real(3) * t[i][k];
            } else {
              force[i][k] -= t[i][k];
              force[tet_middles.between[i][j]][k] += t[i][k];
            }
          }
      }
      for (int m = 4; m < 10; ++m)
        for (int k = 0; k < 3; ++k) force[m][k] *= Real(4);
      for (int a = 0; a < 10; ++a) L::add3(f + offset, at + a * L::width, force[a]);
    }
    at += 10 * L::width;
    point += 4;
  }
}

}  // namespace
