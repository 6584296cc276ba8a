// SPDX-License-Identifier: BSD-3-Clause
// Contribution of one quadrature point to the Galerkin matrix of rigid motions, the largest part of a setup;
// compiled for several instruction sets.
#pragma once

#include <cstddef>
#include <string_view>

namespace kacanov::simd {

/// Length of a motion vector: M = 3 or 6 motions, padded by zeros.
template <int M>
inline constexpr std::size_t motion_lanes = M == 6 ? 8 : 4;

/// A quadrature point of an element whose nodes lie in `groups` aggregates.
template <int M>
struct MotionPoint {
  static constexpr std::size_t dim = M == 6 ? 3 : 2;
  /// Displacements of a node in direction c for each motion of its aggregate: [c][motion], padded by zeros.
  struct Rows {
    alignas(64) double row[dim][motion_lanes<M>];
  };
  std::size_t nodes = 0, groups = 0;   ///< at most 10
  const double* gradient = nullptr;    ///< nodes × dim
  const double* dilatation = nullptr;  ///< nodes × dim, of tr ε; equals `gradient` unless they differ
  const double* hoop = nullptr;        ///< nodes; null: not axisymmetric
  const Rows* rows = nullptr;          ///< per node
  const std::size_t* group = nullptr;  ///< per node, from 0
  double shear = 0.0, bulk = 0.0;      ///< 2 g and k0, times the volume of the point
};

/// Accumulates the product of the motions of groups `a` and `b`: M × M, row-major.
struct MotionPair {
  std::size_t a = 0, b = 0;
  double* sum = nullptr;
};

template <int M>
using AddMotionProducts = void (*)(const MotionPoint<M>&, const MotionPair* pairs, std::size_t count);

/// Returns the loop for the named instruction set (as for choose_instruction_set): for each pair it adds
/// volume · S_aᵀ D S_b, with the strains S_a of the motions of group a. M: 3 or 6.
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
