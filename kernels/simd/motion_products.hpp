// SPDX-License-Identifier: BSD-3-Clause
// What one quadrature point adds to Galerkin's matrix over rigid motions, built for several instruction sets:
// most of a setup.
#pragma once

#include <cstddef>
#include <string_view>

namespace kacanov::simd {

/// Numbers a motion vector has room for: M = 3 or 6 motions and zeros.
template <int M>
inline constexpr std::size_t motion_lanes = M == 6 ? 8 : 4;

/// A point of an element whose nodes lie in `groups` aggregates.
template <int M>
struct MotionPoint {
  static constexpr std::size_t dim = M == 6 ? 3 : 2;
  /// Displacements of a node in direction c by each motion of its aggregate: [c][motion], zero behind the
  /// last.
  struct Rows {
    alignas(64) double row[dim][motion_lanes<M>];
  };
  std::size_t nodes = 0, groups = 0;   ///< at most 10
  const double* gradient = nullptr;    ///< nodes × dim
  const double* dilatation = nullptr;  ///< nodes × dim, of tr ε; `gradient` again unless they differ
  const double* hoop = nullptr;        ///< nodes; null: not axisymmetric
  const Rows* rows = nullptr;          ///< of every node
  const std::size_t* group = nullptr;  ///< of every node, from 0
  double shear = 0.0, bulk = 0.0;      ///< 2 g and k0, times the volume of the point
};

/// Where the product of the motions of groups `a` and `b` is added up: M × M, row-major.
struct MotionPair {
  std::size_t a = 0, b = 0;
  double* sum = nullptr;
};

template <int M>
using AddMotionProducts = void (*)(const MotionPoint<M>&, const MotionPair* pairs, std::size_t count);

/// With S_a the strains of the motions of group a, volume · S_aᵀ D S_b is added for every pair, by the loop
/// for the instruction set of that name (as choose_instruction_set takes it). M: 3 or 6.
template <int M>
AddMotionProducts<M> motion_products(std::string_view instruction_set);

/// The loops of one instruction set.
struct MotionLoops {
  AddMotionProducts<3> plane;
  AddMotionProducts<6> space;
};
MotionLoops motions_plain();
MotionLoops motions_avx2();
MotionLoops motions_avx512();

}  // namespace kacanov::simd
