// SPDX-License-Identifier: BSD-3-Clause
// Strains at the points of consecutive elements, one element per lane, and of polynomials around their
// corners; compiled for several instruction sets.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kacanov::simd {

/// Number of elements processed together.
inline constexpr std::size_t row_lanes = 16;
using RowLanes = std::array<double, row_lanes>;

/// Strains at one point of each element.
struct RowStrain {
  RowLanes dev[6];  ///< xx yy zz xy yz zx
  RowLanes trace, norm;
};

/// Displacement gradient, determinant and strain at one point of each element.
struct RowPoint {
  RowLanes h[3][3];  ///< ∂u_i/∂x_k
  RowLanes det;      ///< of ∂x/∂ξ
  RowStrain strain;
};

/// ∂x/∂ξ at one point of each element: its determinant and thinness (see ElementMap).
struct RowMap {
  RowLanes det, thinness;
};

/// A polynomial of six values around a corner of each element: `terms` monomials 1, x_i and x_i x_j of the
/// distance from the centre times the scale.
template <std::size_t terms>
struct RowPolynomial {
  RowLanes centre[3], scale;
  RowLanes coefficient[terms][6];
};

/// Two strains of each element with their secant moduli, for their difference.
struct RowDifference {
  const RowStrain &a, &b;
  const RowLanes &ga, &gb, &bulk;
};

/// For 3D elements with this many nodes: 4 and 8 are linear, 10 quadratic tetrahedra.
template <std::size_t nodes>
struct RowLoops {
  static constexpr std::size_t corners = nodes == 8 ? 8 : 4, terms = nodes == 10 ? 10 : 4;
  using Nodal = RowLanes[nodes][3];
  /// Input of derivatives. Hexahedra, whose shape functions have opposite slopes at both ends of an edge:
  /// differences along the four edges of each direction. Tetrahedra: the nodal values.
  static constexpr std::size_t sides = nodes == 8 ? 12 : nodes;
  using Sides = RowLanes[sides][3];
  using Polynomials = RowPolynomial<terms>[corners];

  void (*take_sides)(const Nodal& of, Sides& out);
  /// `slopes`: derivatives of the shape functions along reference coordinates, nodes × 3.
  void (*strain)(const double* slopes, const Sides& x, const Sides& u, RowPoint& out);
  /// Raises both to the maximum with this point: largest magnitude of a principal strain, and rotation angle.
  void (*raise)(const RowPoint& to, RowLanes& strain, RowLanes& rotation);
  void (*map)(const double* slopes, const Sides& x, RowMap& out);
  /// `shape`: values of the shape functions.
  void (*position)(const double* shape, const Nodal& x, RowLanes (&out)[3]);
  /// Sums the corners' polynomials, each times its `share`.
  void (*smooth)(const double* share, const Polynomials& of_corner, const RowLanes (&position)[3],
                 RowStrain& out);
  /// sum += weight · ½ max(0, (τ(a) − τ(b)) : (a − b)).
  void (*add_work)(const RowDifference& of, const RowLanes& weight, RowLanes& sum);
};

/// Returns the loops for the named instruction set, as for choose_instruction_set(). nodes: 4, 8, 10.
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
