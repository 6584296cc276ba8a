// SPDX-License-Identifier: BSD-3-Clause
// Strains at the points of elements in a row, side by side, and of polynomials round their corners; built for
// several instruction sets.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kacanov::simd {

/// Elements that are worked on side by side.
inline constexpr std::size_t row_lanes = 16;
using RowLanes = std::array<double, row_lanes>;

/// Strains of a point of each element.
struct RowStrain {
  RowLanes dev[6];  ///< xx yy zz xy yz zx
  RowLanes trace, norm;
};

/// What elements in a row have at a point.
struct RowPoint {
  RowLanes h[3][3];  ///< ∂u_i/∂x_k
  RowLanes det;      ///< of ∂x/∂ξ
  RowStrain strain;
};

/// ∂x/∂ξ at a point of each element: its determinant, and how thin it makes them (see ElementMap).
struct RowMap {
  RowLanes det, thinness;
};

/// A polynomial of six values round a corner of each element: `terms` monomials 1, x_i and x_i x_j of what
/// lies between a place and the centre, times the scale.
template <std::size_t terms>
struct RowPolynomial {
  RowLanes centre[3], scale;
  RowLanes coefficient[terms][6];
};

/// The difference of two strains of each element, with their secant moduli.
struct RowDifference {
  const RowStrain &a, &b;
  const RowLanes &ga, &gb, &bulk;
};

/// Of elements in space with so many nodes: 4 and 8 are linear, 10 quadratic tetrahedra.
template <std::size_t nodes>
struct RowLoops {
  static constexpr std::size_t corners = nodes == 8 ? 8 : 4, terms = nodes == 10 ? 10 : 4;
  using Nodal = RowLanes[nodes][3];
  /// What slopes are taken of: of hexahedra, whose shape functions have opposite slopes at both ends of an
  /// edge, the differences along the four edges of each direction; of tetrahedra the nodal values themselves.
  static constexpr std::size_t sides = nodes == 8 ? 12 : nodes;
  using Sides = RowLanes[sides][3];
  using Polynomials = RowPolynomial<terms>[corners];

  void (*take_sides)(const Nodal& of, Sides& out);
  /// With `slopes` of the shape functions along reference coordinates, nodes × 3.
  void (*strain)(const double* slopes, const Sides& x, const Sides& u, RowPoint& out);
  /// Raises both to what the points have: the largest magnitude of a principal strain, and the angle of
  /// rotation.
  void (*raise)(const RowPoint& to, RowLanes& strain, RowLanes& rotation);
  void (*map)(const double* slopes, const Sides& x, RowMap& out);
  /// With `shape` functions' values.
  void (*position)(const double* shape, const Nodal& x, RowLanes (&out)[3]);
  /// The polynomials of the corners, each with its `share`.
  void (*smooth)(const double* share, const Polynomials& of_corner, const RowLanes (&position)[3],
                 RowStrain& out);
  /// sum += weight · ½ (τ(a) − τ(b)) : (a − b), which is taken for 0 where it is negative.
  void (*add_work)(const RowDifference& of, const RowLanes& weight, RowLanes& sum);
};

/// The loops for the instruction set of that name, as choose_instruction_set() takes it. nodes: 4, 8, 10.
template <std::size_t nodes>
const RowLoops<nodes>& row_loops(std::string_view instruction_set);

/// The loops of one instruction set.
struct AllRowLoops {
  RowLoops<4> tet4;
  RowLoops<8> hex8;
  RowLoops<10> tet10;
};
const AllRowLoops& rows_plain();
const AllRowLoops& rows_avx2();
const AllRowLoops& rows_avx512();

}  // namespace kacanov::simd
