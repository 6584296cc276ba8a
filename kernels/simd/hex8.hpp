// SPDX-License-Identifier: BSD-3-Clause
// Trilinear hexahedra, one per lane: derivatives at the 2×2×2 points by sums and differences.
#pragma once

#include <array>

#include "cells/elements.hpp"
#include "simd/fan.hpp"

namespace {

/// Corners and points by place: bit 0 is set on the upper side in ξ, bit 1 in η, bit 2 in ζ.
constexpr std::array<std::uint8_t, 8> hex_place = [] {
  std::array<std::uint8_t, 8> place{};
  for (std::size_t a = 0; a < 8; ++a) {
    const auto& c = kacanov::elements::Hex8::corner[a];
    place[a] = static_cast<std::uint8_t>((c[0] > 0) + 2 * (c[1] > 0) + 4 * (c[2] > 0));
  }
  return place;
}();

/// The corner at a place.
constexpr std::array<std::uint8_t, 8> hex_corner = [] {
  std::array<std::uint8_t, 8> corner{};
  for (std::size_t a = 0; a < 8; ++a) corner[hex_place[a]] = static_cast<std::uint8_t>(a);
  return corner;
}();

// A trilinear function has eight modes: 1, ξ, η, ξη, ζ, ξζ, ηζ, ξηζ, in the order of the bits of their index.
// Sums of nodal values times ±1 compute them (times eight); the first one does not affect derivatives.

/// Transforms values at the eight places to modes. The inverse is the same except for the sign of bits. Only
/// additions.
template <class V>
KACANOV_INLINE inline void hex_modes(V* v) {
#pragma GCC unroll 3
  for (int bit = 4; bit > 0; bit /= 2)
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i)
      if ((i & bit) == 0) {
        const V low = v[i], high = v[i + bit];
        v[i] = low + high;
        v[i + bit] = high - low;
      }
}

/// Transforms modes to values. The mode `none`, first or last, counts as zero.
template <int none, class V>
KACANOV_INLINE inline void hex_values(V* m) {
#pragma GCC unroll 3
  for (int bit = 1; bit < 8; bit *= 2)
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i)
      if ((i & bit) == 0) {
        const V even = m[i], odd = m[i + bit];
        const bool all_even = bit == 1 && i + bit == none, all_odd = bit == 1 && i == none;
        m[i] = all_even ? even : all_odd ? -odd : even - odd;
        m[i + bit] = all_even ? even : all_odd ? odd : even + odd;
      }
}

/// Modes of a nodal field, components last; modes of several bits are scaled to the Gauss points.
template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline void hex_load(const Real* values, const std::uint16_t* at, V (&m)[3][8]) {
  at = read_anew(at);
  constexpr Real gauss = Real(kacanov::elements::Hex8::gauss);
#pragma GCC unroll 8
  for (int p = 0; p < 8; ++p) {
    V x[3];
    L::load3(values, at + hex_corner[p] * L::width, x);
    for (int k = 0; k < 3; ++k) m[k][p] = x[k];
  }
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    hex_modes(m[k]);
    m[k][3] *= gauss, m[k][5] *= gauss, m[k][6] *= gauss, m[k][7] *= gauss * gauss;
  }
}

/// The transpose: nodal forces from modal forces.
template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline void hex_add(V (&m)[3][8], const std::uint16_t* at, Real* f) {
  at = read_anew(at);
  constexpr Real gauss = Real(kacanov::elements::Hex8::gauss);
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    m[k][3] *= gauss, m[k][5] *= gauss, m[k][6] *= gauss, m[k][7] *= gauss * gauss;
    hex_values<0>(m[k]);
  }
#pragma GCC unroll 8
  for (int p = 0; p < 8; ++p) {
    const V force[3] = {m[0][p], m[1][p], m[2][p]};
    L::add3(f, at + hex_corner[p] * L::width, force);
  }
}

/// Eight times the derivatives along ξ, η, ζ at the points. The derivative along direction k does not depend
/// on ξ_k: four values, indexed by the upper sides in the other two directions.
template <class V>
struct HexSlopes {
  V along[3][4][3];

  static constexpr int slot(int direction, int place) {
    const int x = place & 1, y = place >> 1 & 1, z = place >> 2;
    return direction == 0 ? y + 2 * z : direction == 1 ? x + 2 * z : x + 2 * y;
  }
  KACANOV_INLINE V* at(int direction, int place) { return along[direction][slot(direction, place)]; }
  KACANOV_INLINE const V* at(int direction, int place) const {
    return along[direction][slot(direction, place)];
  }
};

/// Modes of u in its derivative along a direction: the direction's bit alone and with the bits of the other
/// two.
constexpr int hex_slope_modes[3][4] = {{1, 3, 5, 7}, {2, 3, 6, 7}, {4, 5, 6, 7}};

template <class V>
KACANOV_INLINE inline void hex_slopes(const V (&m)[3][8], HexSlopes<V>& slopes) {
#pragma GCC unroll 3
  for (int direction = 0; direction < 3; ++direction)
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      const auto& mode = hex_slope_modes[direction];
      const V low = m[k][mode[0]] - m[k][mode[1]], high = m[k][mode[0]] + m[k][mode[1]];
      const V low_change = m[k][mode[2]] - m[k][mode[3]], high_change = m[k][mode[2]] + m[k][mode[3]];
      slopes.along[direction][0][k] = low - low_change;
      slopes.along[direction][1][k] = high - high_change;
      slopes.along[direction][2][k] = low + low_change;
      slopes.along[direction][3][k] = high + high_change;
    }
}

/// The transpose of hex_slopes.
template <class V>
KACANOV_INLINE inline void hex_gather(const HexSlopes<V>& t, V (&m)[3][8]) {
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    V part[3][4];
#pragma GCC unroll 3
    for (int direction = 0; direction < 3; ++direction) {
      const auto& s = t.along[direction];
      const V low = s[0][k] + s[2][k], low_change = s[2][k] - s[0][k];
      const V high = s[1][k] + s[3][k], high_change = s[3][k] - s[1][k];
      part[direction][0] = low + high;
      part[direction][1] = high - low;
      part[direction][2] = low_change + high_change;
      part[direction][3] = high_change - low_change;
    }
    m[k][1] = part[0][0], m[k][2] = part[1][0], m[k][4] = part[2][0];
    m[k][3] = part[0][1] + part[1][1];
    m[k][5] = part[0][2] + part[2][1];
    m[k][6] = part[1][2] + part[2][2];
    m[k][7] = part[0][3] + part[1][3] + part[2][3];
  }
}

/// det ∇ξ_k, det and weight/det at a point, from the derivatives of the coordinates.
template <class V>
struct HexPoint {
  V c[3][3], det, w;
};

template <class Real, class V>
KACANOV_INLINE inline void hex_measure(const HexSlopes<V>& j, int place, HexPoint<V>& point) {
  const V *a = j.at(0, place), *b = j.at(1, place), *d = j.at(2, place);
  cross(b, d, point.c[0]);
  cross(d, a, point.c[1]);
  cross(a, b, point.c[2]);
  point.det = inner(a, point.c[0]);
  point.w = Real(1.0 / 512.0) / point.det;
}

/// det ε at a point from its derivatives, with doubled shears.
template <class V>
KACANOV_INLINE inline Sym<V> hex_strain(const V* a, const V* b, const V* d, const V (&c)[3][3]) {
  const auto shear = [&](int i, int k) __attribute__((always_inline)) {
    return a[i] * c[0][k] + a[k] * c[0][i] + b[i] * c[1][k] + b[k] * c[1][i] + d[i] * c[2][k] +
           d[k] * c[2][i];
  };
  const auto stretch = [&](int i) __attribute__((always_inline)) {
    return a[i] * c[0][i] + b[i] * c[1][i] + d[i] * c[2][i];
  };
  return {stretch(0), stretch(1), stretch(2), shear(0, 1), shear(1, 2), shear(2, 0)};
}

/// Derivatives are scaled by 8, hence determinants by 512; the weight compensates for this.
template <class L, class Real, class Material>
inline void hex_loop(const Block<Real>& block, const Group& group, const Material& material,
                     Vectors<Real> vectors) {
  using V = typename L::V;
  constexpr Real weight = Real(1.0 / 512.0);
  const bool mean = block.laws[group.law].mean_dilatation;
  const Material at_point = mean ? material.without_bulk() : material;
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, 8 * L::width);
    material.fetch_ahead(point, 8 * L::width);
    HexSlopes<V> j;
    {
      V m[3][8];
      hex_load<L>(block.coordinates, at, m);
      hex_slopes(m, j);
    }
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      HexSlopes<V> slopes, forces;
      {
        V m[3][8];
        hex_load<L>(vectors.u + offset, at, m);
        hex_slopes(m, slopes);
      }
      V pressure{};  // weight times the pressure of the mean dilatation
      if (mean) {
        V change{}, volume{};
#pragma GCC unroll 8
        for (int q = 0; q < 8; ++q) {
          HexPoint<V> p;
          hex_measure<Real>(j, q, p);
          for (int k = 0; k < 3; ++k) change += inner(slopes.at(k, q), p.c[k]);
          volume += p.det;
        }
        pressure = weight * material.bulk() * change / volume;
        material.add_energy(Real(0.5) * pressure * change);
      }
#pragma GCC unroll 8
      for (int q = 0; q < 8; ++q) {
        HexPoint<V> p;
        hex_measure<Real>(j, q, p);
        const Sym<V> e = hex_strain(slopes.at(0, q), slopes.at(1, q), slopes.at(2, q), p.c);
        Sym<V> s = at_point.stress(e, p.det, p.w, weight, point + hex_corner[q]);
        if (mean) s.xx += pressure, s.yy += pressure, s.zz += pressure;
        for (int k = 0; k < 3; ++k) {
          const bool first = (q & (1 << k)) == 0;
          if (first)
            multiply(s, p.c[k], forces.at(k, q));
          else
            add_product(s, p.c[k], forces.at(k, q));
        }
      }
      V m[3][8];
      hex_gather(forces, m);
      hex_add<L>(m, at, vectors.f + offset);
    }
    at += 8 * L::width;
    point += 8;
  }
}

/// Transforms modes of deviatoric strains (xx yy xy yz zx, shears doubled) to modes of half the stresses
/// (full stresses for shears). With g alone each component is independent and stays in registers.
template <class L, class Real, class V>
KACANOV_INLINE inline void affine_stress(const SecantMaterial<L, Real>& material, std::size_t point,
                                         V (&e)[5][8]) {
#pragma GCC unroll 5
  for (int n = 0; n < 5; ++n) {
    hex_values<7>(e[n]);
#pragma GCC unroll 8
    for (int q = 0; q < 8; ++q) e[n][q] *= L::load(material.secant + (point + hex_corner[q]) * L::width);
    hex_modes(e[n]);
  }
}

template <class L, class Real, class V>
KACANOV_INLINE inline void affine_stress(const TangentMaterial<L, Real>& material, std::size_t point,
                                         V (&e)[5][8]) {
#pragma GCC unroll 5
  for (int n = 0; n < 5; ++n) hex_values<7>(e[n]);
#pragma GCC unroll 8
  for (int q = 0; q < 8; ++q) {
    const std::size_t slot = point + hex_corner[q];
    const V g = L::load(material.base.secant + slot * L::width);
    const float* t = material.tangent + tangent_floats * slot * L::width;
    V d[5];
    for (int n = 0; n < 5; ++n) d[n] = L::widen(t + n * L::width);
    const V along = turned(d[0] * e[0][q] + d[1] * e[1][q] + (d[0] + d[1]) * (e[0][q] + e[1][q]) +
                               d[2] * e[2][q] + d[3] * e[3][q] + d[4] * e[4][q],
                           d[0]);
    const V half = Real(0.5) * along;
    for (int n = 0; n < 5; ++n) e[n][q] = g * e[n][q] - (n < 2 ? half : along) * d[n];
  }
#pragma GCC unroll 5
  for (int n = 0; n < 5; ++n) hex_modes(e[n]);
}

/// Parallelepipeds: det ∇ξ_k is the same at all points; strains are computed per mode before they are
/// evaluated at the points, and stresses are reduced to modes before they become forces. The k0 term is
/// diagonal in the modes. About 350 multiplications and 390 additions per batch.
template <class L, class Real, class Material>
inline void affine_hex_loop(const Block<Real>& block, const Group& group, const Material& material,
                            Vectors<Real> vectors) {
  using V = typename L::V;
  const std::uint16_t* at = block.index + group.first_index;
  const V bulk = Real(8) * material.bulk();
  const V higher = block.laws[group.law].mean_dilatation ? V{} : bulk;  // the first mode is the mean
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    fetch_ahead(at, 8 * L::width);
    material.fetch_ahead(point, 8 * L::width);
    V c[3][3], w;  // c: from the edges, hence four times too small, and det eight times too small
    {
      V o[3], x[3][3];
      const std::uint16_t* from = read_anew(at);
      L::load3(block.coordinates, from, o);
#pragma GCC unroll 3
      for (int direction = 0; direction < 3; ++direction) {
        L::load3(block.coordinates, from + hex_corner[1 << direction] * L::width, x[direction]);
        for (int k = 0; k < 3; ++k) x[direction][k] -= o[k];
      }
      for (int k = 0; k < 3; ++k) cross(x[(k + 1) % 3], x[(k + 2) % 3], c[k]);
      w = Real(1.0 / 128.0) / inner(x[0], c[0]);
    }
    for (int v = 0; v < vectors.count; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * vectors.stride;
      V m[3][8], e[5][8], trace[8];
      hex_load<L>(vectors.u + offset, at, m);
#pragma GCC unroll 8
      for (int s = 0; s < 7; ++s) {
        // ∂u/∂ξ_k contains each mode of u that has bit k, with that bit cleared.
        const auto sum = [&](int i, int k) __attribute__((always_inline)) {
          V value{};
#pragma GCC unroll 3
          for (int direction = 0; direction < 3; ++direction)
            if ((s >> direction & 1) == 0) {
              value += m[i][s | 1 << direction] * c[direction][k];
              if (i != k) value += m[k][s | 1 << direction] * c[direction][i];
            }
          return value;
        };
        const V xx = sum(0, 0), yy = sum(1, 1), zz = sum(2, 2);
        trace[s] = xx + yy + zz;
        const V mean = Real(1.0 / 3.0) * trace[s];
        e[0][s] = xx - mean, e[1][s] = yy - mean;
        e[2][s] = sum(0, 1), e[3][s] = sum(1, 2), e[4][s] = sum(2, 0);
      }
      affine_stress<L, Real>(material, point, e);
      V cw[3][3];
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) cw[k][i] = w * c[k][i];
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k)
#pragma GCC unroll 8
        for (int i = 0; i < 8; ++i) m[k][i] = V{};
#pragma GCC unroll 8
      for (int s = 0; s < 7; ++s) {
        const V pressure = (s == 0 ? bulk : higher) * trace[s];
        const Sym<V> t{pressure + Real(2) * e[0][s],
                       pressure + Real(2) * e[1][s],
                       pressure - Real(2) * (e[0][s] + e[1][s]),
                       e[2][s],
                       e[3][s],
                       e[4][s]};
#pragma GCC unroll 3
        for (int direction = 0; direction < 3; ++direction)
          if ((s >> direction & 1) == 0) {
            V force[3] = {m[0][s | 1 << direction], m[1][s | 1 << direction], m[2][s | 1 << direction]};
            add_product(t, cw[direction], force);
            for (int k = 0; k < 3; ++k) m[k][s | 1 << direction] = force[k];
          }
      }
      hex_add<L>(m, at, vectors.f + offset);
    }
    at += 8 * L::width;
    point += 8;
  }
}

}  // namespace
