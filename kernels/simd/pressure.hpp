// SPDX-License-Identifier: BSD-3-Clause
// Forces of pressures at the corners of tetrahedra: linear and quadratic fans, curved elements.
#pragma once

#include "cells/elements.hpp"
#include "simd/element.hpp"
#include "simd/fan.hpp"
#include "simd/tet10.hpp"

namespace {

/// The transpose of add_changes: ∫ p ∇N with p linear between the last entries of the corners' records. With
/// c_a = det ∇λ_a and P the sum of p: (4 p_a − P) c_a at vertex a and (4 p_b + 4 P) c_a + (4 p_a + 4 P) c_b
/// at the midpoint of a and b, all divided by 120.
template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline void add_pressures(const FanGeometry<V>& geometry, const FanPlace& fan, const Real* u,
                                         Real* f) {
  constexpr int width = L::width;
  constexpr Real factor = Real(4.0 / 120.0 / QuadraticFan::scale);
  const std::uint16_t* at = read_anew(fan.at);
  V edge[3][3] = {}, behind[3][3] = {}, ahead[3][3], ring[3], p[4];
  for (int a = 0; a < 2; ++a) p[a] = factor * L::load_last(u, at + a * width);
  p[2] = factor * L::load_last(u, at + 3 * width);
  at += QuadraticFan::before * width;
#pragma GCC unroll 1
  for (int i = 0; i < fan.length; ++i, at += QuadraticFan::step * width) {
    p[3] = factor * L::load_last(u, at + width);
    for (int k = 0; k < 3; ++k) {
      ring[k] = V{};
      for (int a = 0; a < 3; ++a) ahead[a][k] = V{};
    }
    const TetNodes<V> force(edge, behind, ring, ahead);
    TetSlopes<V> slopes(geometry, i);
    slopes.find_p();
    const V sum = p[0] + p[1] + p[2] + p[3];
    const auto add = [&](const V& s, int a, V* to) __attribute__((always_inline)) {
      for (int k = 0; k < 3; ++k)
        to[k] = a % 2 == 0 ? to[k] - s * slopes.at[a][k] : to[k] + s * slopes.at[a][k];
    };
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a) {
      add(p[a] - Real(0.25) * sum, a, force.at[a][a]);
#pragma GCC unroll 4
      for (int b = 0; b < a; ++b) {
        add(p[b] + sum, a, force.at[a][b]);
        add(p[a] + sum, b, force.at[a][b]);
      }
    }
    for (int a = 0; a < 3; ++a) L::add3(f, at - (3 - a) * width, behind[a]);
    L::add3(f, at, ring);
    p[2] = p[3];
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k) behind[a][k] = ahead[a][k];
  }
  for (int a = 0; a < 3; ++a) L::add3(f, at - (3 - a) * width, behind[a]);
  at = read_anew(fan.at);
  for (int a = 0; a < 3; ++a) L::add3(f, at + a * width, edge[a]);
}

template <class L, class Real>
inline void quadratic_fan_pressures(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  over_batches<L, Real, QuadraticFan, false>(
      block, group, vectors, [](const auto& geometry, const FanPlace& fan, const Real* u, Real* f) {
        add_pressures<L, Real>(geometry, fan, u, f);
      });
}

/// The transpose of linear_fan_changes: the average of four pressures, once per tetrahedron.
template <class L, class Real, bool closed>
inline void linear_fan_pressures(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  using V = typename L::V;
  over_batches<L, Real, LinearFan, closed>(
      block, group, vectors, [](const FanGeometry<V>& geometry, const FanPlace& fan, const Real* u, Real* f) {
        constexpr int width = L::width;
        constexpr Real factor = Real(LinearFan::weight / 4.0);
        const std::uint16_t* at = read_anew(fan.at);
        const std::uint16_t* ring = at + LinearFan::ring * width;
        const V of_edge = factor * (L::load_last(u, at) + L::load_last(u, at + width));
        const V of_first = factor * L::load_last(u, ring);
        V of_ring = of_first, q[3] = {}, carry[3] = {}, first[3] = {}, sum[3] = {};
        for (int i = 0; i < fan.length; ++i) {
          const bool closing = closed && i == fan.length - 1;
          const V ahead = closing ? of_first : factor * L::load_last(u, ring + (i + 1) * width);
          const V pressure = of_edge + of_ring + ahead;
          const V* spoke = geometry.spoke[i];
          const V* next_spoke = geometry.spoke[closing ? 0 : i + 1];
          for (int k = 0; k < 3; ++k) {
            carry[k] -= pressure * next_spoke[k];
            sum[k] += carry[k];
            q[k] += pressure * geometry.wedge[i].c[k];
            if (i == 0) first[k] = carry[k];
          }
          if (i > 0) L::add3(f, ring + i * width, carry);
          for (int k = 0; k < 3; ++k) carry[k] = pressure * spoke[k];
          of_ring = ahead;
        }
        for (int k = 0; k < 3; ++k) sum[k] = -(sum[k] + carry[k] + q[k]);
        if constexpr (closed)
          for (int k = 0; k < 3; ++k) first[k] += carry[k];
        else
          L::add3(f, ring + fan.length * width, carry);
        L::add3(f, ring, first);
        L::add3(f, at + width, q);
        L::add3(f, at, sum);
      });
}

/// The transpose of element_changes, for any element that averages at corners.
template <class L, class Real, class E>
inline void element_pressures(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  using V = typename L::V;
  static constexpr auto gradients = reference_gradients<E, Real>();
  static constexpr auto shares = corner_shares<E, Real>();
  const std::uint16_t* at = block.index + group.first_index;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch, at += E::nodes * L::width) {
    V x[E::nodes][3];
    for (int a = 0; a < E::nodes; ++a) L::load3(block.coordinates, at + a * L::width, x[a]);
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      V p[E::corners], force[E::nodes][3] = {};
      for (int a = 0; a < E::corners; ++a) p[a] = L::load_last(vectors.u + offset, at + a * L::width);
      for (int q = 0; q < E::points; ++q) {
        V j[3][3] = {}, pressure{};  // ∂x/∂ξ_k
        for (int a = 0; a < E::nodes; ++a)
          for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) j[k][i] += x[a][i] * gradients.at[q][a][k];
        for (int a = 0; a < E::corners; ++a) pressure += Real(E::weight) * shares.at[q][a] * p[a];
        for (int k = 0; k < 3; ++k) {
          V c[3];
          cross(j[(k + 1) % 3], j[(k + 2) % 3], c);
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < 3; ++i) force[a][i] += pressure * c[i] * gradients.at[q][a][k];
        }
      }
      for (int a = 0; a < E::nodes; ++a) L::add3(vectors.f + offset, at + a * L::width, force[a]);
    }
  }
}

}  // namespace
