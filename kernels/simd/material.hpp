// SPDX-License-Identifier: BSD-3-Clause
// Stress at a batch of quadrature points: the frozen law, its tangent, and the true law.
#pragma once

#include <cmath>
#include <limits>

#include "simd/block.hpp"
#include "simd/inline.hpp"

namespace {

using kacanov::simd::Block;
using kacanov::simd::Group;
using kacanov::simd::LawView;
using kacanov::simd::longest_fan;
using kacanov::simd::Nonlinear;
using kacanov::simd::Outside;
using kacanov::simd::tangent_floats;
using kacanov::simd::Vectors;

/// Symmetric tensor of vectors.
template <class V>
struct Sym {
  V xx, yy, zz, xy, yz, zx;
};

/// v = s n.
template <class V>
KACANOV_INLINE inline void multiply(const Sym<V>& s, const V* n, V* v) {
  v[0] = s.xx * n[0] + s.xy * n[1] + s.zx * n[2];
  v[1] = s.xy * n[0] + s.yy * n[1] + s.yz * n[2];
  v[2] = s.zx * n[0] + s.yz * n[1] + s.zz * n[2];
}

/// v += s n.
template <class V>
KACANOV_INLINE inline void add_product(const Sym<V>& s, const V* n, V* v) {
  v[0] = v[0] + s.xx * n[0] + s.xy * n[1] + s.zx * n[2];
  v[1] = v[1] + s.xy * n[0] + s.yy * n[1] + s.yz * n[2];
  v[2] = v[2] + s.zx * n[0] + s.yz * n[1] + s.zz * n[2];
}
/// v -= s n.
template <class V>
KACANOV_INLINE inline void subtract_product(const Sym<V>& s, const V* n, V* v) {
  v[0] = v[0] - s.xx * n[0] - s.xy * n[1] - s.zx * n[2];
  v[1] = v[1] - s.xy * n[0] - s.yy * n[1] - s.yz * n[2];
  v[2] = v[2] - s.zx * n[0] - s.yz * n[1] - s.zz * n[2];
}

/// v with its sign flipped in the lanes where the sign bit of `sign` is set.
template <class V>
KACANOV_INLINE inline V turned(V v, V sign) {
  typedef decltype(v < v) Bits;
  using Lane = std::remove_cvref_t<decltype(Bits{}[0])>;
  return (V)((Bits)v ^ ((Bits)sign & (Bits{} + std::numeric_limits<Lane>::min())));
}

/// Prefetches a stream about 2 KiB ahead: hardware prefetchers stop at page boundaries.
template <class T>
KACANOV_INLINE inline void fetch_ahead(const T* stream, int count) {
  constexpr int line = 64 / sizeof(T);
  for (int i = 0; i < count; i += line) __builtin_prefetch(stream + 32 * line + i);
}

// A material converts the strain at one point per lane, scaled by det and with doubled shears, to weight·τ;
// forces are that times det ∇N. `weight` is the point's on the reference element, `w` = weight/det. `point`
// counts vectors of points from the start of the group.
//
// The tangent's rank-one term 2 g' x d dᵀ, d = dev ε/x, is stored as the traceless vector √|2 g' x| d: five
// floats. Its sign does not affect the product; the sign bit of its first component is set if g' > 0.

/// Strain (scaled by det) from h[3 i + j] = det ∂u_i/∂x_j.
template <class V>
KACANOV_INLINE inline Sym<V> strain_of(const V* h) {
  return {h[0], h[4], h[8], h[1] + h[3], h[5] + h[7], h[2] + h[6]};
}

template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline Sym<V> frozen_stress(const Sym<V>& e, V g, V bulk, V w) {
  const V gg = g * w, gg2 = gg + gg;
  const V mean = (e.xx + e.yy + e.zz) * (bulk * w - gg2 * Real(1.0 / 3.0));
  return {gg2 * e.xx + mean, gg2 * e.yy + mean, gg2 * e.zz + mean, gg * e.xy, gg * e.yz, gg * e.zx};
}

/// plane_stress_bulk() in each lane.
template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline V bulk_in_plane(V bulk, V g) {
  return g * Real(4.0 / 3.0) * (Real(6) * bulk - g) / (Real(3) * bulk + Real(4) * g);
}

// With `in_plane` the transverse stress is zero (theory: plane-stress), and strains have no zz.

template <class L, class Real, bool in_plane = false>
struct SecantMaterial {
  static constexpr bool frozen = true;
  using V = typename L::V;
  const Real* secant;
  V k0;

  SecantMaterial(const Block<Real>& block, const Group& group)
      : secant(block.secant + group.first_slot), k0(Real(block.laws[group.law].bulk) - V{}) {}

  V bulk() const { return k0; }
  SecantMaterial without_bulk() const {
    SecantMaterial other = *this;
    other.k0 = V{};
    return other;
  }
  V bulk_at(V g) const {
    if constexpr (in_plane)
      return bulk_in_plane<L, Real>(k0, g);
    else
      return k0;
  }
  /// Only the true law counts energies of the mean dilatation.
  void add_energy(V) const {}

  KACANOV_INLINE void fetch_ahead(std::size_t point, int count) const {
    ::fetch_ahead(secant + point * L::width, count);
  }
  template <class Weight>
  KACANOV_INLINE Sym<V> stress(const Sym<V>& e, V, V w, Weight, std::size_t point) const {
    const V g = L::load(secant + point * L::width);
    return frozen_stress<L, Real>(e, g, bulk_at(g), w);
  }
};

template <class L, class Real, bool in_plane = false>
struct TangentMaterial {
  static constexpr bool frozen = true;
  using V = typename L::V;
  SecantMaterial<L, Real, in_plane> base;
  const float* tangent;

  TangentMaterial(const Block<Real>& block, const Group& group)
      : base(block, group), tangent(block.tangent + tangent_floats * std::size_t{group.first_slot}) {}

  V bulk() const { return base.bulk(); }
  TangentMaterial without_bulk() const {
    TangentMaterial other = *this;
    other.base.k0 = V{};
    return other;
  }
  void add_energy(V) const {}

  KACANOV_INLINE void fetch_ahead(std::size_t point, int count) const {
    base.fetch_ahead(point, count);
    ::fetch_ahead(tangent + tangent_floats * point * L::width, tangent_floats * count);
  }
  template <class Weight>
  KACANOV_INLINE Sym<V> stress(const Sym<V>& e, V, V w, Weight, std::size_t point) const {
    const V g = L::load(base.secant + point * L::width);
    Sym<V> s = frozen_stress<L, Real>(e, g, base.bulk_at(g), w);
    const float* t = tangent + tangent_floats * point * L::width;
    const V xx = L::widen(t), yy = L::widen(t + L::width), xy = L::widen(t + 2 * L::width),
            yz = L::widen(t + 3 * L::width), zx = L::widen(t + 4 * L::width);
    const V zz = xx + yy;  // −zz, from the zero trace
    const V along = turned(w, xx) * (xx * e.xx + yy * e.yy - zz * e.zz + xy * e.xy + yz * e.yz + zx * e.zx);
    s.xx -= along * xx, s.yy -= along * yy, s.zz += along * zz;
    s.xy -= along * xy, s.yz -= along * yz, s.zx -= along * zx;
    return s;
  }
};

/// With `by_others` the moduli come from outside (Block::outside). Compiled separately, because a run-time
/// check would cost the other laws a fifth of a hex8's residual.
template <class L, class Real, bool by_others, bool in_plane = false>
struct NonlinearMaterial {
  static constexpr bool frozen = false;
  using V = typename L::V;
  const LawView& law;
  Nonlinear& out;
  Real* secant;
  float* tangent;
  double k0;
  const Real* free_strain;
  Outside<Real> outside;

  NonlinearMaterial(const Block<Real>& block, const Group& group, Nonlinear& nonlinear)
      : law(block.laws[group.law]),
        out(nonlinear),
        secant(block.secant + group.first_slot),
        tangent(block.tangent == nullptr ? nullptr
                                         : block.tangent + tangent_floats * std::size_t{group.first_slot}),
        k0(law.bulk),
        free_strain(block.free_strain == nullptr ? nullptr : block.free_strain + group.first_slot),
        outside(block.outside.from(group.first_slot)) {}

  V bulk() const { return Real(k0) - V{}; }
  NonlinearMaterial without_bulk() const {
    NonlinearMaterial other = *this;
    other.k0 = 0.0;
    return other;
  }
  void add_energy(V density) const {
    for (int l = 0; l < L::width; ++l) out.energies[l] += double(density[l]);
  }

  KACANOV_INLINE void fetch_ahead(std::size_t, int) const {}
  /// `weight` is a number, or one value per lane in axisymmetric bodies.
  template <class Weight>
  KACANOV_INLINE Sym<V> stress(const Sym<V>& total, V det, V w, Weight weight, std::size_t point) const {
    Sym<V> e = total;
    if constexpr (in_plane)
      if (free_strain != nullptr) {
        const V longer = det * L::load(free_strain + point * L::width);
        e.xx -= longer, e.yy -= longer;
      }
    const V inverse = w * (Real(1) / weight), half = Real(0.5) * inverse;
    V e_zz = e.zz * inverse;
    if constexpr (in_plane) e_zz = across(e.xx * inverse, e.yy * inverse, e.xy * half);
    const V trace = (e.xx + e.yy) * inverse + e_zz, mean = trace * Real(1.0 / 3.0);
    const V xx = e.xx * inverse - mean, yy = e.yy * inverse - mean, zz = e_zz - mean;
    const V xy = e.xy * half, yz = e.yz * half, zx = e.zx * half;
    const V x = L::sqrt(xx * xx + yy * yy + zz * zz + Real(2) * (xy * xy + yz * yz + zx * zx));
    const std::size_t slot = point * L::width;
    if constexpr (by_others)
      if (outside.strain != nullptr) {
        L::store(outside.strain + slot, x);
        return Sym<V>{};
      }
    V g = Real(law.shear) - V{}, slope = V{}, energy = Real(0.5 * law.shear) * x * x;
    if constexpr (by_others) {
      g = L::load(outside.secant + slot);
      slope = outside.slope == nullptr ? V{} : L::load(outside.slope + slot);
      energy = outside.energy == nullptr ? V{} : L::load(outside.energy + slot);
    } else {
      if (L::any_above(x, Real(law.elastic) - V{}))
        for (int l = 0; l < L::width; ++l)
          if (double(x[l]) > law.elastic) {
            double lane_g, lane_slope, lane_energy = 0.0;
            law.evaluate(law.law, double(x[l]), &lane_g, &lane_slope,
                         out.sum_energy ? &lane_energy : nullptr);
            g[l] = Real(lane_g), slope[l] = Real(lane_slope), energy[l] = Real(lane_energy);
          }
    }
    add_energy(det * weight * (Real(0.5 * k0) * trace * trace + Real(2) * energy));
    if (out.keep_secant) L::store(secant + slot, g);
    if constexpr (in_plane) {
      if (out.keep_tangent)
        keep_in_plane(Sym<V>{xx, yy, zz, xy, yz, zx}, x, {g, slope}, tangent + tangent_floats * slot);
      return frozen_stress<L, Real>(e, g, bulk_in_plane<L, Real>(bulk(), g), w);
    } else {
      if (out.keep_tangent) keep(Sym<V>{xx, yy, zz, xy, yz, zx}, x, slope, tangent + tangent_floats * slot);
      return frozen_stress<L, Real>(e, g, bulk(), w);
    }
  }

  /// Transverse strain at which the transverse stress vanishes.
  V across(V xx, V yy, V xy) const {
    const auto ratio = Real((3.0 * k0 - 2.0 * law.shear) / (3.0 * k0 + 4.0 * law.shear));
    const V plane = xx + yy, mean = plane * ((Real(1) - ratio) * Real(1.0 / 3.0));
    V zz = plane * -ratio;
    const V a = xx - mean, b = yy - mean, c = zz - mean;
    const V x = L::sqrt(a * a + b * b + c * c + Real(2) * xy * xy);
    for (int l = 0; l < L::width; ++l)
      if (double(x[l]) > law.elastic)
        zz[l] = Real(law.across(law.law, double(xx[l]), double(yy[l]), double(xy[l])));
    return zz;
  }

  /// keep() for the in-plane part of the term in plane stress: condensed() in each lane.
  struct At {
    V g, slope;
  };
  void keep_in_plane(const Sym<V>& dev, V x, const At& at, float* t) const {
    for (int l = 0; l < L::width; ++l) {
      const double g = double(at.g[l]), slope = double(at.slope[l]), zz = double(dev.zz[l]);
      const double factor = slope != 0.0 ? 2.0 * slope / double(x[l]) : 0.0;
      const double left = factor / (1.0 + factor * zz * zz / (k0 + 4.0 / 3.0 * g));
      const double share = (3.0 * k0 - 2.0 * g) / (3.0 * k0 + 4.0 * g) * zz;
      const double values[tangent_floats] = {double(dev.xx[l]) - share, double(dev.yy[l]) - share,
                                             double(dev.xy[l]), 0.0, 0.0};
      const bool turn = std::signbit(values[0]) != (slope > 0.0);
      const double length = std::sqrt(std::abs(left));
      for (int k = 0; k < tangent_floats; ++k)
        t[k * L::width + l] = static_cast<float>(length * (turn ? -values[k] : values[k]));
    }
  }

  /// √|2 g' x| dev ε/x, with the sign bit of its first component set if g' > 0; zero if g' = 0.
  static void keep(const Sym<V>& dev, V x, V slope, float* t) {
    const V values[tangent_floats] = {dev.xx, dev.yy, dev.xy, dev.yz, dev.zx};
    typedef decltype(x < x) Bits;
    using Lane = std::remove_cvref_t<decltype(Bits{}[0])>;
    const Bits sign = Bits{} + std::numeric_limits<Lane>::min();
    const Bits turn = ((Bits)dev.xx ^ (slope > V{})) & sign;
    const V length = slope != V{} ? L::sqrt((V)((Bits)(Real(2) * slope / x) & ~sign)) : V{};
    const V factor = (V)((Bits)length | turn);
    for (int k = 0; k < tangent_floats; ++k) L::narrow(t + k * L::width, factor * values[k]);
  }
};

}  // namespace
