// SPDX-License-Identifier: BSD-3-Clause
// Fans of linear tetrahedra, one per lane: p, q and a ring r_0 … r_n, tetrahedra (p, q, r_i, r_{i+1}).
#pragma once

#include "simd/material.hpp"

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

/// Adds each lane's value to the last entry of its record, lane by lane because lanes may share a record.
template <class L, class Real>
KACANOV_INLINE inline void add_last(Real* base, const std::uint16_t* at, typename L::V value) {
  for (int l = 0; l < L::width; ++l) base[at[l] + 3] += value[l];
}

/// e_i × e_{i+1}, the point's weight divided by the determinant, and the determinant.
template <class V>
struct Wedge {
  V c[3], w, det;
};

/// Geometry of a batch of fans with edges e_i = r_i − p and e_q = q − p: spoke e_q × e_i for each ring node,
/// one wedge for each tetrahedron.
template <class V>
struct FanGeometry {
  V spoke[longest_fan + 1][3];
  Wedge<V> wedge[longest_fan];
};

/// Index of the first ring node in a fan and stride of the ring nodes; weight of a point; factor by which the
/// loop scales all products of edges.
struct LinearFan {
  static constexpr int ring = 2, step = 1;
  static constexpr double weight = 1.0 / 6.0, scale = 1.0;
  static constexpr int nodes(int length, bool closed) { return length + (closed ? 2 : 3); }
};

template <class L, class Real, class Fan, bool closed, class V = typename L::V>
KACANOV_INLINE inline void measure_fan(const Real* coordinates, const std::uint16_t* at, int length,
                                       FanGeometry<V>& geometry) {
  constexpr Real scale = Real(Fan::scale), unscale = Real(1.0 / Fan::scale), weight = Real(Fan::weight);
  V p[3], eq[3], e[3], first[3];
  const std::uint16_t* ring = at + Fan::ring * L::width;
  L::load3(coordinates, at, p);
  L::load3(coordinates, at + L::width, eq);
  L::load3(coordinates, ring, e);
  for (int k = 0; k < 3; ++k) eq[k] = scale * (eq[k] - p[k]), e[k] -= p[k], first[k] = e[k];
  cross(eq, e, geometry.spoke[0]);
  const auto measure = [&](const V* a, const V* b, Wedge<V>& wedge) __attribute__((always_inline)) {
    cross(a, b, wedge.c);
    wedge.det = unscale * inner(eq, wedge.c);
    wedge.w = weight / wedge.det;
    for (int k = 0; k < 3; ++k) wedge.c[k] *= scale;
  };
  const int ring_nodes = length + (closed ? 0 : 1);
#pragma GCC unroll 8
  for (int i = 1; i < ring_nodes; ++i) {
    V next[3];
    L::load3(coordinates, ring + Fan::step * i * L::width, next);
    for (int k = 0; k < 3; ++k) next[k] -= p[k];
    cross(eq, next, geometry.spoke[i]);
    measure(e, next, geometry.wedge[i - 1]);
    for (int k = 0; k < 3; ++k) e[k] = next[k];
  }
  if constexpr (closed) measure(e, first, geometry.wedge[length - 1]);
}

/// The material, without the bulk modulus if that acts on averages.
template <bool averaged, class Material>
KACANOV_INLINE inline decltype(auto) choose_bulk(const Material& material) {
  if constexpr (averaged)
    return material.without_bulk();
  else
    return (material);
}

/// Position of a batch of fans: its indices, its first point, and the number of tetrahedra per fan.
struct FanPlace {
  const std::uint16_t* at;
  std::size_t point;
  int length;
};

/// Forces of one input vector. p gets minus the sum of all others. A ring node's force is stored one step
/// late, to hide its latency. `averaged`: tr ε is the mean of the corner averages, the last entries of the
/// corners' records.
template <class L, class Real, bool closed, bool averaged, class Material, class V = typename L::V>
KACANOV_INLINE inline void load_fan(const Material& material, const FanGeometry<V>& geometry,
                                    const FanPlace& fan, const Real* u, Real* f) {
  const std::uint16_t* at = read_anew(fan.at);
  const int length = fan.length;
  const std::uint16_t* ring = at + 2 * L::width;
  V p[3], dq[3], d[3], first[3];
  V fq[3] = {}, carry[3] = {}, done[3] = {}, first_force[3] = {}, sum[3] = {};
  L::load3(u, at, p);
  L::load3(u, at + L::width, dq);
  L::load3(u, ring, d);
  for (int k = 0; k < 3; ++k) dq[k] -= p[k], d[k] -= p[k], first[k] = d[k];
  // k0/24 times the averages: sum of p and q, r_i, and r_0.
  [[maybe_unused]] const V bulk = Real(LinearFan::weight / 4.0) * material.bulk();
  [[maybe_unused]] V of_edge{}, of_ring{}, of_first{};
  if constexpr (averaged) {
    of_edge = bulk * (L::load_last(u, at) + L::load_last(u, at + L::width));
    of_ring = of_first = bulk * L::load_last(u, ring);
  }
  const Material& at_point = choose_bulk<averaged>(material);
#pragma GCC unroll 8
  for (int i = 0; i < length; ++i) {
    const bool closing = closed && i == length - 1;
    const V* spoke = geometry.spoke[i];
    const V* next_spoke = geometry.spoke[closing ? 0 : i + 1];
    const Wedge<V>& wedge = geometry.wedge[i];
    V next[3];
    if (closing) {
      for (int k = 0; k < 3; ++k) next[k] = first[k];
    } else {
      L::load3(u, ring + (i + 1) * L::width, next);
      for (int k = 0; k < 3; ++k) next[k] -= p[k];
    }
    V h[9];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        h[3 * r + c] = dq[r] * wedge.c[c] - d[r] * next_spoke[c] + next[r] * spoke[c];
    if (i > 1) L::add3(f, ring + (i - 1) * L::width, done);
    Sym<V> s = at_point.stress(strain_of(h), wedge.det, wedge.w, Real(LinearFan::weight),
                               fan.point + static_cast<std::size_t>(i));
    if constexpr (averaged) {
      const V ahead = closing ? of_first : bulk * L::load_last(u, ring + (i + 1) * L::width);
      const V pressure = of_edge + of_ring + ahead;
      s.xx += pressure, s.yy += pressure, s.zz += pressure;
      of_ring = ahead;
    }
    subtract_product(s, next_spoke, carry);
    for (int k = 0; k < 3; ++k) {
      sum[k] += carry[k];
      if (i == 0)
        first_force[k] = carry[k];
      else
        done[k] = carry[k];
    }
    add_product(s, wedge.c, fq);
    multiply(s, spoke, carry);
    for (int k = 0; k < 3; ++k) d[k] = next[k];
  }
  if (length > 1) L::add3(f, ring + (length - 1) * L::width, done);
  if constexpr (closed)
    for (int k = 0; k < 3; ++k) first_force[k] += carry[k];
  else
    L::add3(f, ring + length * L::width, carry);
  L::add3(f, ring, first_force);
  L::add3(f, at + L::width, fq);
  for (int k = 0; k < 3; ++k) sum[k] = -(sum[k] + carry[k] + fq[k]);
  L::add3(f, at, sum);
}

/// Computes the geometry first, in the first-level cache, then every input vector, so that stresses do not
/// wait for divisions (the processor looks ahead about 60 vector operations, less than one tetrahedron): 113
/// instead of 149 cycles per 8 tetrahedra (Zen 4; minimum: 81 multiply-adds). A `fixed` length > 0 unrolls
/// the ring: 15 % faster.
template <class L, class Real, bool closed, bool averaged, int fixed, class Material>
inline void fan_loop(const Block<Real>& block, const Group& group, const Material& material,
                     Vectors<Real> vectors) {
  const int length = fixed > 0 ? fixed : int{group.length};
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, (length + 3) * L::width);
    material.fetch_ahead(point, length * L::width);
    FanGeometry<typename L::V> geometry;
    measure_fan<L, Real, LinearFan, closed>(block.coordinates, at, length, geometry);
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      load_fan<L, Real, closed, averaged>(material, geometry, {at, point, length}, vectors.u + offset,
                                          vectors.f + offset);
    }
    at += (length + (closed ? 2 : 3)) * L::width;
    point += static_cast<std::size_t>(length);
  }
}

/// The most frequent lengths have their own loops; several input vectors and the true law, which have other
/// bottlenecks, share one loop for all lengths.
template <class L, class Real, bool closed, bool averaged, class Material>
inline void fan_loop_of_length(const Block<Real>& block, const Group& group, const Material& material,
                               Vectors<Real> vectors) {
  const auto run = [&]<int fixed>() {
    fan_loop<L, Real, closed, averaged, fixed>(block, group, material, vectors);
  };
  if constexpr (Material::frozen) {
    switch (group.length - (closed ? 3 : 0)) {
      case 1: return run.template operator()<1 + (closed ? 3 : 0)>();
      case 2: return run.template operator()<2 + (closed ? 3 : 0)>();
      case 3: return run.template operator()<3 + (closed ? 3 : 0)>();
      case 4: return run.template operator()<4 + (closed ? 3 : 0)>();
      case 5: return run.template operator()<5 + (closed ? 3 : 0)>();
      default: break;
    }
  }
  run.template operator()<0>();
}

/// Calls work<closed>(), depending on the shape of the group's fans.
template <class Work>
inline void closed_or_open(const Group& group, const Work& work) {
  if (group.shape == kacanov::simd::Shape::open_fan)
    work.template operator()<false>();
  else
    work.template operator()<true>();
}

/// Calls work(geometry, fan, u, f) for every batch of fans and every input vector.
template <class L, class Real, class Fan, bool closed, class Work>
inline void over_batches(const Block<Real>& block, const Group& group, Vectors<Real> vectors,
                         const Work& work) {
  const int length = group.length, nodes = Fan::nodes(length, closed);
  const std::uint16_t* at = block.index + group.first_index;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, nodes * L::width);
    FanGeometry<typename L::V> geometry;
    measure_fan<L, Real, Fan, closed>(block.coordinates, at, length, geometry);
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      work(geometry, FanPlace{at, 0, length}, vectors.u + offset, vectors.f + offset);
    }
    at += nodes * L::width;
  }
}

/// ∫ N tr ε around each corner: a quarter of each element's volume change. With displacements relative to p,
/// that is u_q · wedge − u_i · spoke_{i+1} + u_{i+1} · spoke_i.
template <class L, class Real, bool closed>
inline void linear_fan_changes(const Block<Real>& block, const Group& group, Vectors<Real> vectors) {
  using V = typename L::V;
  over_batches<L, Real, LinearFan, closed>(
      block, group, vectors, [](const FanGeometry<V>& geometry, const FanPlace& fan, const Real* u, Real* f) {
        constexpr int width = L::width;
        const std::uint16_t* at = read_anew(fan.at);
        const std::uint16_t* ring = at + LinearFan::ring * width;
        V p[3], q[3], d[3], first[3], sum{}, carry{}, of_first{};
        L::load3(u, at, p);
        L::load3(u, at + width, q);
        L::load3(u, ring, d);
        for (int k = 0; k < 3; ++k) q[k] -= p[k], d[k] -= p[k], first[k] = d[k];
        for (int i = 0; i < fan.length; ++i) {
          const bool closing = closed && i == fan.length - 1;
          V next[3];
          if (closing) {
            for (int k = 0; k < 3; ++k) next[k] = first[k];
          } else {
            L::load3(u, ring + (i + 1) * width, next);
            for (int k = 0; k < 3; ++k) next[k] -= p[k];
          }
          const V change = Real(LinearFan::weight / 4.0) *
                           (inner(q, geometry.wedge[i].c) - inner(d, geometry.spoke[closing ? 0 : i + 1]) +
                            inner(next, geometry.spoke[i]));
          sum += change;
          if (closed && i == 0)
            of_first = change;
          else
            add_last<L, Real>(f, ring + i * width, carry + change);
          carry = change;
          for (int k = 0; k < 3; ++k) d[k] = next[k];
        }
        add_last<L, Real>(f, ring + (closed ? 0 : fan.length) * width, closed ? of_first + carry : carry);
        add_last<L, Real>(f, at, sum);
        add_last<L, Real>(f, at + width, sum);
      });
}

}  // namespace
