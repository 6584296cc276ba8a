// SPDX-License-Identifier: BSD-3-Clause
// Trilinear hexahedra, one a lane: derivatives at the 2×2×2 points by one-dimensional sums.
#pragma once

#include "elements/hex8.hpp"
#include "fan.hpp"

namespace {

/// Whether corner (or point) a lies on the upper side in each direction.
struct HexCorner {
  int x, y, z;
};

constexpr HexCorner hex_corner(int a) {
  const auto& c = kacanov::elements::Hex8::corner[static_cast<std::size_t>(a)];
  return {c[0] > 0, c[1] > 0, c[2] > 0};
}

constexpr int hex_node(int x, int y, int z) {
  for (int a = 0; a < 8; ++a)
    if (const HexCorner c = hex_corner(a); c.x == x && c.y == y && c.z == z) return a;
  return -1;
}

/// A derivative along direction k does not depend on ξ_k: four values, by place in the other two directions.
template <class V>
struct HexSlopes {
  V along[3][2][2][3];

  V* at(int direction, const HexCorner& c) {
    return direction == 0 ? along[0][c.y][c.z] : direction == 1 ? along[1][c.x][c.z] : along[2][c.x][c.y];
  }
};

/// Nodes at the lower and upper ends of the four edges along each direction. A table: the compiler folds its
/// entries where it would not run a search.
struct HexEdges {
  int end[3][2][2][2];
};

constexpr HexEdges hex_edges = [] {
  HexEdges table{};
  for (int p = 0; p < 2; ++p)
    for (int q = 0; q < 2; ++q)
      for (int upper = 0; upper < 2; ++upper) {
        table.end[0][p][q][upper] = hex_node(upper, p, q);
        table.end[1][p][q][upper] = hex_node(p, upper, q);
        table.end[2][p][q][upper] = hex_node(p, q, upper);
      }
  return table;
}();

/// From edges to Gauss points in two directions; symmetric, so that it serves forces too. The half of a
/// derivative's difference is in it.
template <class Real, class V>
KACANOV_INLINE inline void hex_interpolate(V (&v)[2][2][3]) {
  constexpr Real gauss = Real(kacanov::elements::Hex8::gauss);
  constexpr Real near = (1 + gauss) / 2, far = (1 - gauss) / 2;
  for (int k = 0; k < 3; ++k) {
    for (int p = 0; p < 2; ++p) {
      const V a = v[p][0][k], b = v[p][1][k];
      v[p][0][k] = near / 2 * a + far / 2 * b;
      v[p][1][k] = far / 2 * a + near / 2 * b;
    }
    for (int q = 0; q < 2; ++q) {
      const V a = v[0][q][k], b = v[1][q][k];
      v[0][q][k] = near * a + far * b;
      v[1][q][k] = far * a + near * b;
    }
  }
}

template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline void hex_slopes(const Real* values, const std::uint16_t* at, HexSlopes<V>& slopes) {
  V x[8][3];
#pragma GCC unroll 8
  for (int a = 0; a < 8; ++a) L::load3(values, at + a * L::width, x[a]);
#pragma GCC unroll 3
  for (int direction = 0; direction < 3; ++direction) {
#pragma GCC unroll 4
    for (int edge = 0; edge < 4; ++edge) {
      const int low = hex_edges.end[direction][edge / 2][edge % 2][0],
                high = hex_edges.end[direction][edge / 2][edge % 2][1];
      for (int k = 0; k < 3; ++k) slopes.along[direction][edge / 2][edge % 2][k] = x[high][k] - x[low][k];
    }
    hex_interpolate<Real>(slopes.along[direction]);
  }
}

/// The transpose of hex_slopes: f += forces of what belongs to each derivative.
template <class L, class Real, class V = typename L::V>
KACANOV_INLINE inline void hex_forces(HexSlopes<V>& t, const std::uint16_t* at, Real* f) {
  V force[8][3] = {};
#pragma GCC unroll 3
  for (int direction = 0; direction < 3; ++direction) {
    hex_interpolate<Real>(t.along[direction]);
#pragma GCC unroll 4
    for (int edge = 0; edge < 4; ++edge) {
      const int low = hex_edges.end[direction][edge / 2][edge % 2][0],
                high = hex_edges.end[direction][edge / 2][edge % 2][1];
      for (int k = 0; k < 3; ++k) {
        force[low][k] -= t.along[direction][edge / 2][edge % 2][k];
        force[high][k] += t.along[direction][edge / 2][edge % 2][k];
      }
    }
  }
#pragma GCC unroll 8
  for (int a = 0; a < 8; ++a) L::add3(f, at + a * L::width, force[a]);
}

/// Some 850 multiply-adds and 500 additions for the 8 points of each lane, against 3500 by shape functions.
template <class L, class Real, class Material>
inline void hex_loop(const Block<Real>& block, const Group& group, const Material& material, const Real* u,
                     Real* f, int vectors, std::size_t stride, Ahead& ahead) {
  using V = typename L::V;
  static constexpr HexCorner corner[8] = {hex_corner(0), hex_corner(1), hex_corner(2), hex_corner(3),
                                          hex_corner(4), hex_corner(5), hex_corner(6), hex_corner(7)};
  const std::uint16_t* at = block.index + group.first_index;
  std::size_t point = 0;
  for (std::uint32_t batch = 0; batch < group.batches; ++batch) {
    ahead.step();
    V c[8][3][3], det[8], w[8];  // c: det ∇ξ_k
    HexSlopes<V> j;
    hex_slopes<L>(block.coordinates, at, j);
#pragma GCC unroll 8
    for (int q = 0; q < 8; ++q) {
      const V *a = j.at(0, corner[q]), *b = j.at(1, corner[q]), *d = j.at(2, corner[q]);
      cross(b, d, c[q][0]);
      cross(d, a, c[q][1]);
      cross(a, b, c[q][2]);
      det[q] = inner(a, c[q][0]);
      w[q] = Real(1) / det[q];
    }
    for (int v = 0; v < vectors; ++v) {
      const std::size_t offset = static_cast<std::size_t>(v) * stride;
      HexSlopes<V> slopes, forces = {};
      hex_slopes<L>(u + offset, at, slopes);
#pragma GCC unroll 8
      for (int q = 0; q < 8; ++q) {
        const V *a = slopes.at(0, corner[q]), *b = slopes.at(1, corner[q]), *d = slopes.at(2, corner[q]);
        V h[9];
        for (int i = 0; i < 3; ++i)
          for (int m = 0; m < 3; ++m)
            h[3 * i + m] = a[i] * c[q][0][m] + b[i] * c[q][1][m] + d[i] * c[q][2][m];
        const Sym<V> s = material.stress(h, det[q], w[q], Real(1), point + static_cast<std::size_t>(q));
        for (int k = 0; k < 3; ++k) add_product(s, c[q][k], forces.at(k, corner[q]));
      }
      hex_forces<L>(forces, at, f + offset);
    }
    at += 8 * L::width;
    point += 8;
  }
}

}  // namespace
