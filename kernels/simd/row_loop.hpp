// SPDX-License-Identifier: BSD-3-Clause
// Loops over consecutive elements. Included once per instruction set, with its compiler flags.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "simd/inline.hpp"
#include "simd/row_points.hpp"

namespace kacanov::simd {
namespace {

#if defined(__AVX512F__)
constexpr std::size_t vector_bytes = 64;
#elif defined(__AVX2__)
constexpr std::size_t vector_bytes = 32;
#else
constexpr std::size_t vector_bytes = 16;
#endif
/// Explicit vectors: compilers do not vectorise scalar loops of this length.
using Pack [[gnu::vector_size(vector_bytes)]] = double;
constexpr std::size_t pack_lanes = vector_bytes / sizeof(double);

KACANOV_INLINE inline Pack load(const RowLanes& lanes, std::size_t first) {
  Pack pack;
  std::memcpy(&pack, &lanes[first], sizeof pack);
  return pack;
}
KACANOV_INLINE inline void store(Pack pack, std::size_t first, RowLanes& lanes) {
  std::memcpy(&lanes[first], &pack, sizeof pack);
}

void take_roots(RowLanes& squares) {
  for (double& square : squares) square = std::sqrt(square);
}

/// Splits a strain xx yy zz xy yz zx into deviator, trace and squared norm.
KACANOV_INLINE inline void split(const Pack (&strain)[6], std::size_t first, RowStrain& out) {
  const Pack trace = strain[0] + strain[1] + strain[2], third = trace * (1.0 / 3.0);
  Pack square{};
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i) {
    const Pack stretch = strain[i] - third, shear = strain[3 + i];
    square += stretch * stretch + 2.0 * (shear * shear);
    store(stretch, first, out.dev[i]);
    store(shear, first, out.dev[3 + i]);
  }
  store(trace, first, out.trace);
  store(square, first, out.norm);
}

/// End nodes of the edges of a hexahedron, four along each reference coordinate.
constexpr std::size_t edge_ends[12][2] = {{0, 1}, {3, 2}, {4, 5}, {7, 6}, {0, 3}, {1, 2},
                                          {4, 7}, {5, 6}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

template <std::size_t nodes>
using RowSides = typename RowLoops<nodes>::Sides;

template <std::size_t nodes>
void take_sides(const RowLanes (&of)[nodes][3], RowSides<nodes>& out) {
  for (std::size_t side = 0; side < RowLoops<nodes>::sides; ++side)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t lane = 0; lane < row_lanes; ++lane)
        if constexpr (nodes == 8)
          out[side][i][lane] = of[edge_ends[side][1]][i][lane] - of[edge_ends[side][0]][i][lane];
        else
          out[side][i][lane] = of[side][i][lane] - of[0][i][lane];
}

/// Derivatives of a component along the reference coordinates.
template <std::size_t nodes>
KACANOV_INLINE inline void add_slopes(const double* slopes, const RowSides<nodes>& of, std::size_t i,
                                      std::size_t first, Pack (&sum)[3]) {
  if constexpr (nodes == 8) {
#pragma GCC unroll 12
    for (std::size_t side = 0; side < 12; ++side)
      sum[side / 4] += slopes[3 * edge_ends[side][1] + side / 4] * load(of[side][i], first);
  } else {
    for (std::size_t a = 0; a < nodes; ++a) {
      const Pack at = load(of[a][i], first);
#pragma GCC unroll 3
      for (std::size_t k = 0; k < 3; ++k) sum[k] += slopes[3 * a + k] * at;
    }
  }
}

/// Computes j = ∂x/∂ξ and the adjugate, det j times the inverse. Returns det j.
template <std::size_t nodes>
KACANOV_INLINE inline Pack map_at(const double* slopes, const RowSides<nodes>& x, std::size_t first,
                                  Pack (&j)[3][3], Pack (&adjugate)[3][3]) {
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i) add_slopes<nodes>(slopes, x, i, first, j[i]);
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i)
#pragma GCC unroll 3
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      adjugate[k][i] = j[i1][k1] * j[i2][k2] - j[i1][k2] * j[i2][k1];
    }
  return j[0][0] * adjugate[0][0] + j[0][1] * adjugate[1][0] + j[0][2] * adjugate[2][0];
}

template <std::size_t nodes>
void map_of_row(const double* slopes, const RowSides<nodes>& x, RowMap& out) {
  RowLanes stretch, inverse;
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes) {
    Pack j[3][3] = {}, adjugate[3][3];
    store(map_at<nodes>(slopes, x, first, j, adjugate), first, out.det);
    Pack of_j{}, of_adjugate{};
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i)
#pragma GCC unroll 3
      for (std::size_t k = 0; k < 3; ++k) {
        of_j += j[i][k] * j[i][k];
        of_adjugate += adjugate[i][k] * adjugate[i][k];
      }
    store(of_j, first, stretch);
    store(of_adjugate, first, inverse);
  }
  take_roots(stretch);
  take_roots(inverse);
  for (std::size_t lane = 0; lane < row_lanes; ++lane) {
    const double size = stretch[lane] * inverse[lane];
    const bool known = size > 0.0 && size < std::numeric_limits<double>::infinity();
    out.thinness[lane] = known ? 3.0 * out.det[lane] / size : 0.0;
  }
}

template <std::size_t nodes>
void strain_of_row(const double* slopes, const RowSides<nodes>& x, const RowSides<nodes>& u, RowPoint& out) {
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes) {
    Pack j[3][3] = {}, inverse[3][3], h[3][3];
    const Pack det = map_at<nodes>(slopes, x, first, j, inverse);
    const Pack scale = 1.0 / det;
    store(det, first, out.det);
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i) {
      Pack d[3] = {};
      add_slopes<nodes>(slopes, u, i, first, d);
#pragma GCC unroll 3
      for (std::size_t k = 0; k < 3; ++k) {
        h[i][k] = scale * (d[0] * inverse[0][k] + d[1] * inverse[1][k] + d[2] * inverse[2][k]);
        store(h[i][k], first, out.h[i][k]);
      }
    }
    const Pack strain[6] = {h[0][0],
                            h[1][1],
                            h[2][2],
                            0.5 * (h[0][1] + h[1][0]),
                            0.5 * (h[1][2] + h[2][1]),
                            0.5 * (h[2][0] + h[0][2])};
    split(strain, first, out.strain);
  }
  take_roots(out.strain.norm);
}

/// cos(φ/3) as a function of z = sin²(φ/8), 0 ≤ φ ≤ π: the series of F(a, −a; ½; sin² y) = cos(2 a y)
/// (Abramowitz and Stegun, 15.1.17) with a = 4/3. z ≤ 0.147, so that the truncation error is below rounding.
constexpr auto third_of_angle = [] {
  constexpr double a = 4.0 / 3.0;
  std::array<double, 19> term{1.0};
  for (std::size_t n = 0; n + 1 < term.size(); ++n) {
    const auto k = static_cast<double>(n);
    term[n + 1] = term[n] * (k + a) * (k - a) / ((k + 0.5) * (k + 1.0));
  }
  return term;
}();

/// Computes cos(φ/3) from (1 + cos φ)/2.
void take_thirds(RowLanes& angle) {
  take_roots(angle);  // cos(φ/2)
  for (double& lane : angle) lane = 0.5 * (1.0 + lane);
  take_roots(angle);  // cos(φ/4)
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes) {
    const Pack z = 0.5 * (1.0 - load(angle, first));
    Pack sum{};
    for (std::size_t n = third_of_angle.size(); n-- > 0;) sum = sum * z + third_of_angle[n];
    store(sum, first, angle);
  }
}

/// Principal strains as reference::largest_principal() computes them, without calls of cosine functions.
void raise_to_largest(const RowPoint& to, RowLanes& strain, RowLanes& rotation) {
  RowLanes mean, half_length, upper, lower, turn;
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes) {
    const auto h = [&](std::size_t i, std::size_t k) { return load(to.h[i][k], first); };
    store((h(0, 0) + h(1, 1) + h(2, 2)) * (1.0 / 3.0), first, mean);
    const Pack x = h(2, 1) - h(1, 2), y = h(0, 2) - h(2, 0), z = h(1, 0) - h(0, 1);
    store(0.25 * (x * x + y * y + z * z), first, turn);
    const Pack norm = load(to.strain.norm, first), p = norm * (std::numbers::inv_sqrt3 / std::numbers::sqrt2);
    store(p, first, half_length);
    constexpr double nothing = 1e-150;
    const Pack scale = norm > nothing ? 1.0 / p : Pack{};
    const auto dev = [&](std::size_t c) { return scale * load(to.strain.dev[c], first); };
    const Pack a = dev(0), b = dev(1), c = dev(2), d = dev(3), e = dev(4), f = dev(5);
    const Pack det = a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
    Pack cosine = 0.5 * det;
    cosine = cosine > 1.0 ? Pack{} + 1.0 : cosine;
    cosine = cosine < -1.0 ? Pack{} - 1.0 : cosine;
    store(0.5 * (1.0 + cosine), first, upper);
    store(0.5 * (1.0 - cosine), first, lower);
  }
  take_roots(turn);
  take_thirds(upper);
  take_thirds(lower);
  for (std::size_t lane = 0; lane < row_lanes; ++lane) {
    const double high = std::abs(mean[lane] + 2.0 * half_length[lane] * upper[lane]);
    const double low = std::abs(mean[lane] - 2.0 * half_length[lane] * lower[lane]);
    const double largest = high > low ? high : low;
    strain[lane] = largest > strain[lane] ? largest : strain[lane];
    rotation[lane] = turn[lane] > rotation[lane] ? turn[lane] : rotation[lane];
  }
}

template <std::size_t nodes>
void position_in_row(const double* shape, const RowLanes (&x)[nodes][3], RowLanes (&out)[3]) {
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes)
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i) {
      Pack sum{};
      for (std::size_t a = 0; a < nodes; ++a) sum += shape[a] * load(x[a][i], first);
      store(sum, first, out[i]);
    }
}

template <std::size_t terms, std::size_t corners>
void smooth_in_row(const double* share, const RowPolynomial<terms> (&of_corner)[corners],
                   const RowLanes (&position)[3], RowStrain& out) {
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes) {
    Pack sum[6] = {};
    for (std::size_t a = 0; a < corners; ++a) {
      const RowPolynomial<terms>& of = of_corner[a];
      const Pack scale = load(of.scale, first);
      Pack y[3], term[terms];
      term[0] = Pack{} + share[a];
#pragma GCC unroll 3
      for (std::size_t i = 0; i < 3; ++i) {
        y[i] = scale * (load(position[i], first) - load(of.centre[i], first));
        term[1 + i] = share[a] * y[i];
      }
      if constexpr (terms == 10) {
        std::size_t k = 4;
#pragma GCC unroll 3
        for (std::size_t i = 0; i < 3; ++i)
#pragma GCC unroll 3
          for (std::size_t j = i; j < 3; ++j) term[k++] = term[1 + i] * y[j];
      }
#pragma GCC unroll 10
      for (std::size_t k = 0; k < terms; ++k)
#pragma GCC unroll 6
        for (std::size_t v = 0; v < 6; ++v) sum[v] += term[k] * load(of.coefficient[k][v], first);
    }
    split(sum, first, out);
  }
  take_roots(out.norm);
}

void add_work_in_row(const RowDifference& of, const RowLanes& weight, RowLanes& sum) {
  for (std::size_t first = 0; first < row_lanes; first += pack_lanes) {
    const Pack ga = 2.0 * load(of.ga, first), gb = 2.0 * load(of.gb, first);
    const Pack trace = load(of.a.trace, first) - load(of.b.trace, first);
    Pack work = load(of.bulk, first) * trace * trace;
#pragma GCC unroll 6
    for (std::size_t c = 0; c < 6; ++c) {
      const Pack a = load(of.a.dev[c], first), b = load(of.b.dev[c], first);
      work += (c < 3 ? 1.0 : 2.0) * ((ga * a - gb * b) * (a - b));
    }
    const Pack positive = work > 0.0 ? work : Pack{};
    store(load(sum, first) + load(weight, first) * (0.5 * positive), first, sum);
  }
}

template <std::size_t nodes>
constexpr RowLoops<nodes> loops_of{
    take_sides<nodes>,      strain_of_row<nodes>,
    raise_to_largest,       map_of_row<nodes>,
    position_in_row<nodes>, smooth_in_row<RowLoops<nodes>::terms, RowLoops<nodes>::corners>,
    add_work_in_row};

constexpr AllRowLoops all_row_loops{loops_of<4>, loops_of<8>, loops_of<10>};

}  // namespace
}  // namespace kacanov::simd
