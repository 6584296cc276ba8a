// SPDX-License-Identifier: BSD-3-Clause
// Quadratic tetrahedra with straight sides, one a lane: their strain is linear, given by its vertex values.
#pragma once

#include "cells/tet10.hpp"
#include "simd/fan.hpp"

namespace {

/// The mid-side node between vertices i and j. A table: the compiler folds its entries where it would not run
/// a search.
struct TetMiddles {
  int between[4][4];
};

constexpr TetMiddles tet_middles = [] {
  TetMiddles table{};
  for (const auto& edge : kacanov::elements::Tet10::edge)
    table.between[edge.a][edge.b] = table.between[edge.b][edge.a] = edge.middle;
  return table;
}();

/// ∂u/∂λ_i at vertex j is 4 u_ij − u_i, and 3 u_i for i = j. A point's value of a linear function is `rest`
/// times the value at its vertex plus `far` times the sum of all four; the transpose of that is the same.
/// `averaged`: tr ε is the mean of those round the corners, in the last places of their records.
template <class L, class Real, bool averaged, class Material>
inline void tet10_loop(const Block<Real>& block, const Group& group, const Material& material,
                       Vectors<Real> vectors) {
  using V = typename L::V;
  [[maybe_unused]] const V bulk = Real(1.0 / 24.0) * material.bulk();
  const auto choose = [&]() -> decltype(auto) {
    if constexpr (averaged)
      return material.without_bulk();
    else
      return (material);
  };
  const Material& at_point = choose();
  constexpr Real far = Real(kacanov::elements::Tet10::far);
  constexpr Real rest = Real(kacanov::elements::Tet10::near - kacanov::elements::Tet10::far);
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, 10 * L::width);
    material.fetch_ahead(point, 4 * L::width);
    V x[4][3], c[3][3];  // c: det ∇λ_{k+1}
    for (int a = 0; a < 4; ++a) L::load3(block.coordinates, at + a * L::width, x[a]);
    for (int a = 1; a < 4; ++a)
      for (int k = 0; k < 3; ++k) x[a][k] -= x[0][k];
    cross(x[2], x[3], c[0]);
    cross(x[3], x[1], c[1]);
    cross(x[1], x[2], c[2]);
    const V det = inner(x[1], c[0]), w = Real(1.0 / 24.0) / det;
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      const std::uint16_t* from = read_anew(at);
      V d[10][3], h[4][9], h_sum[9], s[4][6], s_sum[6];
#pragma GCC unroll 10
      for (int a = 0; a < 10; ++a) L::load3(vectors.u + offset, from + a * L::width, d[a]);
#pragma GCC unroll 4
      for (int j = 0; j < 4; ++j) {
        V r[3][3];  // ∂u/∂λ_{i+1} − ∂u/∂λ_0 at vertex j
#pragma GCC unroll 3
        for (int i = 1; i < 4; ++i)
#pragma GCC unroll 3
          for (int k = 0; k < 3; ++k) {
            const V own = i == j ? Real(3) * d[i][k] : Real(4) * d[tet_middles.between[i][j]][k] - d[i][k];
            const V base = j == 0 ? Real(3) * d[0][k] : Real(4) * d[tet_middles.between[0][j]][k] - d[0][k];
            r[i - 1][k] = own - base;
          }
#pragma GCC unroll 9
        for (int n = 0; n < 9; ++n) {
          h[j][n] = r[0][n / 3] * c[0][n % 3] + r[1][n / 3] * c[1][n % 3] + r[2][n / 3] * c[2][n % 3];
          h_sum[n] = j == 0 ? h[j][n] : h_sum[n] + h[j][n];
        }
      }
      for (int n = 0; n < 9; ++n) h_sum[n] *= far;
      [[maybe_unused]] V mean[4], mean_sum;
      if constexpr (averaged) {
#pragma GCC unroll 4
        for (int a = 0; a < 4; ++a) mean[a] = bulk * L::load_last(vectors.u + offset, from + a * L::width);
        mean_sum = far * (mean[0] + mean[1] + mean[2] + mean[3]);
      }
#pragma GCC unroll 4
      for (int q = 0; q < 4; ++q) {
        V h_point[9];
        for (int n = 0; n < 9; ++n) h_point[n] = rest * h[q][n] + h_sum[n];
        Sym<V> t = at_point.stress(strain_of(h_point), det, w, Real(1.0 / 24.0),
                                   point + static_cast<std::size_t>(q));
        if constexpr (averaged) {
          const V pressure = rest * mean[q] + mean_sum;
          t.xx += pressure, t.yy += pressure, t.zz += pressure;
        }
        s[q][0] = t.xx, s[q][1] = t.yy, s[q][2] = t.zz, s[q][3] = t.xy, s[q][4] = t.yz, s[q][5] = t.zx;
        for (int n = 0; n < 6; ++n) s_sum[n] = q == 0 ? s[q][n] : s_sum[n] + s[q][n];
      }
      for (int n = 0; n < 6; ++n) s_sum[n] *= far;
      V force[10][3] = {};
#pragma GCC unroll 4
      for (int j = 0; j < 4; ++j) {
        const Sym<V> stress{rest * s[j][0] + s_sum[0], rest * s[j][1] + s_sum[1], rest * s[j][2] + s_sum[2],
                            rest * s[j][3] + s_sum[3], rest * s[j][4] + s_sum[4], rest * s[j][5] + s_sum[5]};
        V t[4][3];
#pragma GCC unroll 3
        for (int i = 1; i < 4; ++i) multiply(stress, c[i - 1], t[i]);
        for (int k = 0; k < 3; ++k) t[0][k] = -(t[1][k] + t[2][k] + t[3][k]);
#pragma GCC unroll 4
        for (int i = 0; i < 4; ++i)
#pragma GCC unroll 3
          for (int k = 0; k < 3; ++k) {
            if (i == j) {
              force[i][k] += Real(3) * t[i][k];
            } else {
              force[i][k] -= t[i][k];
              force[tet_middles.between[i][j]][k] += Real(4) * t[i][k];
            }
          }
      }
      from = read_anew(at);
#pragma GCC unroll 10
      for (int a = 0; a < 10; ++a) L::add3(vectors.f + offset, from + a * L::width, force[a]);
    }
    at += 10 * L::width;
    point += 4;
  }
}

/// ∫ N tr ε over the elements of every corner. At vertex j det tr ε is Σ_i ∂u/∂λ_i · c_i, c_i = det ∇λ_i, so
/// with m_ij = u_ij · c_i of the mid-side nodes 4 Σ_(i≠j) m_ij − Σ_i u_i · c_i + 4 u_j · c_j; the integral of
/// a linear function and N takes the corner's value and the sum of all, times det/120.
template <class L, class Real>
inline void tet10_changes(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  using V = typename L::V;
  const std::uint16_t* at = block.index + group.first_index;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch, at += 10 * L::width) {
    fetch_ahead(at, 10 * L::width);
    V x[4][3], c[4][3];
    for (int a = 0; a < 4; ++a) L::load3(block.coordinates, at + a * L::width, x[a]);
    for (int a = 1; a < 4; ++a)
      for (int k = 0; k < 3; ++k) x[a][k] -= x[0][k];
    cross(x[2], x[3], c[1]);
    cross(x[3], x[1], c[2]);
    cross(x[1], x[2], c[3]);
    for (int k = 0; k < 3; ++k) c[0][k] = -(c[1][k] + c[2][k] + c[3][k]);
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      const std::uint16_t* from = read_anew(at);
      V own[4], trace[4] = {}, sum{};
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) {
        V u[3];
        L::load3(vectors.u + offset, from + i * L::width, u);
        own[i] = inner(u, c[i]);
      }
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i)
#pragma GCC unroll 4
        for (int j = 0; j < i; ++j) {
          V u[3];
          L::load3(vectors.u + offset, from + tet_middles.between[i][j] * L::width, u);
          trace[j] += inner(u, c[i]), trace[i] += inner(u, c[j]);
        }
      for (int j = 0; j < 4; ++j) sum += trace[j];
      const V rest = Real(4) * sum - (own[0] + own[1] + own[2] + own[3]);
      for (int j = 0; j < 4; ++j)
        add_last<L, Real>(vectors.f + offset, from + j * L::width,
                          Real(1.0 / 120.0) * (Real(4) * (trace[j] + own[j]) + rest));
    }
  }
}

}  // namespace
