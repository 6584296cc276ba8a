// SPDX-License-Identifier: BSD-3-Clause
// Fans of linear tetrahedra: p, q and a ring r_0 … r_n, tetrahedra (p, q, r_i, r_{i+1}), a fan a lane.
#pragma once

#include "material.hpp"

namespace {

template <class V>
KACANOV_INLINE inline void cross(const V* a, const V* b, V* c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

template <class V>
KACANOV_INLINE inline V inner(const V* a, const V* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A ring node: its edge from p, q's edge × that, and for each right side its displacement over p's and
/// the force gathered so far.
template <class V, int vectors>
struct RingNode {
  V e[3], w[3], d[vectors][3], f[vectors][3];
};

/// Two cross products a tetrahedron instead of three: those with the edge pq serve both neighbours. p takes
/// minus the sum of all other forces.
template <class L, class Real, bool closed, int vectors, class Material>
inline void fan_loop(const Block<Real>& block, const Group& group, const Material& material, const Real* u,
                     Real* f, std::size_t stride) {
  using V = typename L::V;
  constexpr int width = L::width;
  const int length = group.length, nodes = length + (closed ? 2 : 3);
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch, at += nodes * width) {
    V p[3], up[vectors][3], eq[3], dq[vectors][3], fq[vectors][3] = {}, sum[vectors][3] = {};
    L::load3(block.coordinates, at, p);
    L::load3(block.coordinates, at + width, eq);
    for (int k = 0; k < 3; ++k) eq[k] -= p[k];
    for (int v = 0; v < vectors; ++v) {
      L::load3(u + v * stride, at, up[v]);
      L::load3(u + v * stride, at + width, dq[v]);
      for (int k = 0; k < 3; ++k) dq[v][k] -= up[v][k];
    }
    const auto load_ring = [&](const std::uint16_t* node, RingNode<V, vectors>& r)
        __attribute__((always_inline)) {
      L::load3(block.coordinates, node, r.e);
      for (int k = 0; k < 3; ++k) r.e[k] -= p[k];
      for (int v = 0; v < vectors; ++v) {
        L::load3(u + v * stride, node, r.d[v]);
        for (int k = 0; k < 3; ++k) r.d[v][k] -= up[v][k];
      }
      cross(eq, r.e, r.w);
    };
    const auto tetrahedron = [&](RingNode<V, vectors> & a, RingNode<V, vectors> & b)
        __attribute__((always_inline)) {
      V c[3];
      cross(a.e, b.e, c);
      const V det = inner(eq, c);
      for (int v = 0; v < vectors; ++v) {
        V h[9];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            h[3 * i + j] = dq[v][i] * c[j] - a.d[v][i] * b.w[j] + b.d[v][i] * a.w[j];
        const Sym<V> s = material.stress(h, det, Real(1.0 / 6.0), point);
        V t[3];
        multiply(s, c, t);
        for (int k = 0; k < 3; ++k) fq[v][k] += t[k];
        multiply(s, b.w, t);
        for (int k = 0; k < 3; ++k) a.f[v][k] -= t[k];
        multiply(s, a.w, b.f[v]);
      }
      ++point;
    };
    const auto store_ring = [&](const std::uint16_t* node, const RingNode<V, vectors>& r)
        __attribute__((always_inline)) {
      for (int v = 0; v < vectors; ++v) {
        L::add3(f + v * stride, node, r.f[v]);
        for (int k = 0; k < 3; ++k) sum[v][k] += r.f[v][k];
      }
    };
    const std::uint16_t* ring = at + 2 * width;
    RingNode<V, vectors> first, last, next;
    load_ring(ring, first);
    for (int v = 0; v < vectors; ++v)
      for (int k = 0; k < 3; ++k) first.f[v][k] = V{};
    load_ring(ring + width, last);
    tetrahedron(first, last);
    for (int i = 2; i < length + (closed ? 0 : 1); ++i) {
      load_ring(ring + i * width, next);
      tetrahedron(last, next);
      store_ring(ring + (i - 1) * width, last);
      last = next;
    }
    const std::uint16_t* end = ring + (closed ? length - 1 : length) * width;
    if constexpr (closed) {
      RingNode<V, vectors> again = first;
      tetrahedron(last, again);
      for (int v = 0; v < vectors; ++v)
        for (int k = 0; k < 3; ++k) first.f[v][k] += again.f[v][k];
    }
    store_ring(end, last);
    store_ring(ring, first);
    for (int v = 0; v < vectors; ++v) {
      L::add3(f + v * stride, at + width, fq[v]);
      for (int k = 0; k < 3; ++k) sum[v][k] = -(sum[v][k] + fq[v][k]);
      L::add3(f + v * stride, at, sum[v]);
    }
  }
}

}  // namespace
