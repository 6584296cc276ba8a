// SPDX-License-Identifier: BSD-3-Clause
// Fans of quadratic tetrahedra with straight edges around an edge pq, one per lane: the strain is linear,
// given by its vertex values.
#pragma once

#include "cells/elements.hpp"
#include "simd/fan.hpp"

namespace {

/// Nodes of a fan: p, q, their midpoint; r_0, its midpoints to p and q; then for each tetrahedron (p, q, r_i,
/// r_{i+1}) the midpoint of its ring edge, r_{i+1}, and the midpoints from that to p and q. Products of edges
/// are scaled by 4 `rest`, the factor of a displacement at the point next to its vertex.
struct QuadraticFan {
  static constexpr double far = kacanov::elements::Tet10::far;
  static constexpr double rest = kacanov::elements::Tet10::near - far;
  static constexpr int ring = 3, step = 4;
  static constexpr double weight = kacanov::elements::Tet10::weight, scale = 4.0 * rest;
  static constexpr int before = 6;  ///< number of nodes before those of the first tetrahedron
  static constexpr int nodes(int length, bool = false) { return before + step * length; }
};

/// A value at the nodes of a tetrahedron: at[i][j] is the midpoint of an edge or, for i = j, a vertex.
/// Vertices are p, q, r_i and r_{i+1}.
template <class V>
struct TetNodes {
  V* at[4][4];

  KACANOV_INLINE TetNodes(V (&edge)[3][3], V (&behind)[3][3], V (&ring)[3], V (&ahead)[3][3])
      : at{{edge[0], edge[2], behind[1], ahead[1]},
           {edge[2], edge[1], behind[2], ahead[2]},
           {behind[1], behind[2], behind[0], ring},
           {ahead[1], ahead[2], ring, ahead[0]}} {}
};

/// det ∇λ of the vertices, with opposite sign for p and r_i. find_p() computes that of p when it is needed:
/// storing it from the start made the strains 2 to 5 % slower by spills.
template <class V>
struct TetSlopes {
  V p[3];
  const V* at[4];

  KACANOV_INLINE TetSlopes(const FanGeometry<V>& geometry, int i)
      : at{p, geometry.wedge[i].c, geometry.spoke[i + 1], geometry.spoke[i]} {}
  KACANOV_INLINE void find_p() {
    for (int k = 0; k < 3; ++k) p[k] = at[1][k] - at[2][k] + at[3][k];
  }
  /// f += s det ∇λ of a vertex.
  KACANOV_INLINE void add(const Sym<V>& s, int vertex, V* f) const {
    if (vertex % 2 == 0)
      subtract_product(s, at[vertex], f);
    else
      add_product(s, at[vertex], f);
  }
};

/// e += strain of r ⊗ n.
template <class V>
KACANOV_INLINE inline void add_strain(const V* r, const V* n, Sym<V>& e) {
  e.xx += r[0] * n[0], e.yy += r[1] * n[1], e.zz += r[2] * n[2];
  e.xy += r[0] * n[1], e.yz += r[1] * n[2], e.zx += r[2] * n[0];
  e.xy += r[1] * n[0], e.yz += r[2] * n[1], e.zx += r[0] * n[2];
}
template <class V>
KACANOV_INLINE inline void subtract_strain(const V* r, const V* n, Sym<V>& e) {
  e.xx -= r[0] * n[0], e.yy -= r[1] * n[1], e.zz -= r[2] * n[2];
  e.xy -= r[0] * n[1], e.yz -= r[1] * n[2], e.zx -= r[2] * n[0];
  e.xy -= r[1] * n[0], e.yz -= r[2] * n[1], e.zx -= r[0] * n[2];
}

/// e += strain of the displacement with `value` at the vertices.
template <class V>
KACANOV_INLINE inline void add_strain_of(const V* const* value, const TetSlopes<V>& slopes, Sym<V>& e) {
  V r[3];
#pragma GCC unroll 3
  for (int i = 1; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) r[k] = value[i][k] - value[0][k];
    if (i == 2)
      subtract_strain(r, slopes.at[i], e);
    else
      add_strain(r, slopes.at[i], e);
  }
}

/// Returns a + f b.
template <class V, class Real>
KACANOV_INLINE inline Sym<V> plus(const Sym<V>& a, Real f, const Sym<V>& b) {
  return {a.xx + f * b.xx, a.yy + f * b.yy, a.zz + f * b.zz,
          a.xy + f * b.xy, a.yz + f * b.yz, a.zx + f * b.zx};
}

/// ∂u/∂λ_i at vertex j is 4 u_ij − u_i with u_jj = u_j, and a linear function at a point is `rest` times its
/// vertex value plus `far` times the sum of all four. So at point j it is `scale` times u_ij + m_i, with m_i
/// = far/rest Σ_(j≠i) u_ij − u_i/4 at all points. The forces are the transpose.
template <class L, class Real, bool averaged, class Material, class V = typename L::V>
KACANOV_INLINE inline void load_quadratic_fan(const Material& material, const FanGeometry<V>& geometry,
                                              const FanPlace& fan, const Real* u, Real* f) {
  constexpr int width = L::width;
  constexpr Real share = Real(QuadraticFan::far / QuadraticFan::rest), quarter = Real(0.25);
  const std::uint16_t* at = read_anew(fan.at);
  V edge[3][3], behind[3][3], ahead[3][3], ring[3];
  V edge_force[3][3] = {}, behind_force[3][3] = {}, ahead_force[3][3], ring_force[3];
  for (int a = 0; a < 3; ++a) L::load3(u, at + a * width, edge[a]);
  for (int a = 0; a < 3; ++a) L::load3(u, at + (3 + a) * width, behind[a]);
  // k0/24 times the averages around the vertices.
  [[maybe_unused]] const V bulk = Real(QuadraticFan::weight) * material.bulk();
  [[maybe_unused]] V mean[4];
  if constexpr (averaged) {
    for (int a = 0; a < 2; ++a) mean[a] = bulk * L::load_last(u, at + a * width);
    mean[2] = bulk * L::load_last(u, at + 3 * width);
  }
  const Material& at_point = choose_bulk<averaged>(material);
  at += QuadraticFan::before * width;
#pragma GCC unroll 1
  for (int i = 0; i < fan.length; ++i, at += QuadraticFan::step * width) {
    L::load3(u, at, ring);
    for (int a = 0; a < 3; ++a) L::load3(u, at + (1 + a) * width, ahead[a]);
    const TetNodes<V> value(edge, behind, ring, ahead),
        force(edge_force, behind_force, ring_force, ahead_force);
    TetSlopes<V> slopes(geometry, i);
    Sym<V> common{}, s[4], sum;
    {
      V m[4][3];
#pragma GCC unroll 4
      for (int a = 0; a < 4; ++a)
#pragma GCC unroll 3
        for (int k = 0; k < 3; ++k)
          m[a][k] = share * (value.at[a][(a + 1) % 4][k] + value.at[a][(a + 2) % 4][k] +
                             value.at[a][(a + 3) % 4][k]) -
                    quarter * value.at[a][a][k];
      const V* const all[4] = {m[0], m[1], m[2], m[3]};
      add_strain_of(all, slopes, common);
    }
    [[maybe_unused]] V pressure[4];
    if constexpr (averaged) {
      mean[3] = bulk * L::load_last(u, at + width);
      const V mean_sum = Real(QuadraticFan::far) * (mean[0] + mean[1] + mean[2] + mean[3]);
      for (int q = 0; q < 4; ++q) pressure[q] = Real(QuadraticFan::rest) * mean[q] + mean_sum;
    }
#pragma GCC unroll 4
    for (int q = 0; q < 4; ++q) {
      Sym<V> e = common;
      add_strain_of<V>(value.at[q], slopes, e);
      const Wedge<V>& wedge = geometry.wedge[i];
      s[q] = at_point.stress(e, wedge.det, wedge.w, Real(QuadraticFan::weight),
                             fan.point + static_cast<std::size_t>(4 * i + q));
      if constexpr (averaged) s[q].xx += pressure[q], s[q].yy += pressure[q], s[q].zz += pressure[q];
      sum = q == 0 ? s[q] : plus(sum, Real(1), s[q]);
    }
    slopes.find_p();
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a) {
      if (a == 3)
        multiply(plus(s[a], -quarter, sum), slopes.at[a], ahead_force[0]);
      else
        slopes.add(plus(s[a], -quarter, sum), a, force.at[a][a]);
    }
    L::add3(f, at - 3 * width, behind_force[0]);
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a) s[a] = plus(s[a], share, sum);
#pragma GCC unroll 3
    for (int a = 0; a < 2; ++a) {
      slopes.add(s[a], 2, force.at[a][2]);
      slopes.add(s[2], a, force.at[a][2]);
      L::add3(f, at - (2 - a) * width, force.at[a][2]);
    }
    multiply(s[2], slopes.at[3], ring_force);
    slopes.add(s[3], 2, ring_force);
    L::add3(f, at, ring_force);
    slopes.add(s[0], 1, edge_force[2]);
    slopes.add(s[1], 0, edge_force[2]);
#pragma GCC unroll 2
    for (int a = 0; a < 2; ++a) {
      multiply(s[a], slopes.at[3], ahead_force[1 + a]);
      slopes.add(s[3], a, ahead_force[1 + a]);
    }
    if constexpr (averaged) mean[2] = mean[3];
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k) behind[a][k] = ahead[a][k], behind_force[a][k] = ahead_force[a][k];
  }
  for (int a = 0; a < 3; ++a) L::add3(f, at - (3 - a) * width, behind_force[a]);
  at = read_anew(fan.at);
  for (int a = 0; a < 3; ++a) L::add3(f, at + a * width, edge_force[a]);
}

/// Fans instead of single tetrahedra halve the loads and additions of records, which took most of the time.
/// `averaged`: tr ε is the mean of the corner averages, the last entries of the corners' records.
template <class L, class Real, bool averaged, class Material>
inline void quadratic_fan_loop(const Block<Real>& block, const Group& group, const Material& material,
                               Vectors<Real> vectors) {
  const int length = group.length;
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, QuadraticFan::nodes(length) * L::width);
    material.fetch_ahead(point, 4 * length * L::width);
    FanGeometry<typename L::V> geometry;
    measure_fan<L, Real, QuadraticFan, false>(block.coordinates, at, length, geometry);
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      load_quadratic_fan<L, Real, averaged>(material, geometry, {at, point, length}, vectors.u + offset,
                                            vectors.f + offset);
    }
    at += QuadraticFan::nodes(length) * L::width;
    point += static_cast<std::size_t>(4 * length);
  }
}

/// ∫ N tr ε around each corner. At vertex j det tr ε is Σ_i ∂u/∂λ_i · c_i, c_i = det ∇λ_i; with m_ij = u_ij ·
/// c_i of the mid-side nodes this is 4 Σ_(i≠j) m_ij − Σ_i u_i · c_i + 4 u_j · c_j. The integral of a linear
/// function times N is (corner value + sum of all values) times det/120.
template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline void add_changes(const FanGeometry<V>& geometry, const FanPlace& fan, const Real* u,
                                       Real* f) {
  constexpr int width = L::width;
  constexpr Real factor = Real(1.0 / 120.0 / QuadraticFan::scale);
  const std::uint16_t* at = read_anew(fan.at);
  V edge[3][3], behind[3][3], ahead[3][3], ring[3], change[3] = {};  // of p, q, r_i
  for (int a = 0; a < 3; ++a) L::load3(u, at + a * width, edge[a]);
  for (int a = 0; a < 3; ++a) L::load3(u, at + (3 + a) * width, behind[a]);
  at += QuadraticFan::before * width;
#pragma GCC unroll 1
  for (int i = 0; i < fan.length; ++i, at += QuadraticFan::step * width) {
    L::load3(u, at, ring);
    for (int a = 0; a < 3; ++a) L::load3(u, at + (1 + a) * width, ahead[a]);
    const TetNodes<V> value(edge, behind, ring, ahead);
    TetSlopes<V> slopes(geometry, i);
    slopes.find_p();
    V own[4], trace[4] = {}, sum{};
    const auto product = [&](int a, int b) __attribute__((always_inline)) {
      const V dot = inner(value.at[a][b], slopes.at[b]);
      return b % 2 == 0 ? -dot : dot;
    };
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a) own[a] = product(a, a);
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a)
#pragma GCC unroll 4
      for (int b = 0; b < a; ++b) trace[b] += product(b, a), trace[a] += product(a, b);
    for (int a = 0; a < 4; ++a) sum += trace[a];
    const V rest = Real(4) * sum - (own[0] + own[1] + own[2] + own[3]);
    for (int a = 0; a < 3; ++a) change[a] += Real(4) * (trace[a] + own[a]) + rest;
    add_last<L, Real>(f, at - 3 * width, factor * change[2]);
    change[2] = Real(4) * (trace[3] + own[3]) + rest;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k) behind[a][k] = ahead[a][k];
  }
  add_last<L, Real>(f, at - 3 * width, factor * change[2]);
  for (int a = 0; a < 2; ++a) add_last<L, Real>(f, fan.at + a * width, factor * change[a]);
}

template <class L, class Real>
inline void quadratic_fan_changes(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  over_batches<L, Real, QuadraticFan, false>(
      block, group, vectors, [](const auto& geometry, const FanPlace& fan, const Real* u, Real* f) {
        add_changes<L, Real>(geometry, fan, u, f);
      });
}

}  // namespace
