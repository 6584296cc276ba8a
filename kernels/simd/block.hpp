// SPDX-License-Identifier: BSD-3-Clause
// What an element loop sees of a block: plain arrays, so that code built for one instruction set shares no
// inline function with code built for another.
#pragma once

#include <cstddef>
#include <cstdint>

#include <kacanov/mesh_view.hpp>

namespace kacanov::simd {

/// What a lane holds: an open or closed fan of tetrahedra, or one element, be it an affine image of the
/// reference element (a tet10 with straight sides, a hex8 that is a parallelepiped) or not.
enum class Shape : std::uint8_t { open_fan, closed_fan, affine, general };

/// The law of a group, as far as the loops evaluate it themselves.
struct LawView {
  double bulk;           ///< k0
  double shear;          ///< g up to `elastic`
  double elastic;        ///< strain norm up to which g is constant
  bool mean_dilatation;  ///< k0 sees the element's mean of tr ε, or those round its corners
  const void* law;       ///< handed back to `evaluate`
  /// g and dg/dx at the strain norm x, and G unless `energy` is null.
  void (*evaluate)(const void* law, double x, double* g, double* slope, double* energy);
  /// The strain across the plane that leaves no stress there (theory: plane-stress).
  double (*across)(const void* law, double xx, double yy, double xy);
};

/// Batches of one shape, length and law, one unit a lane.
struct Group {
  ElementType type;
  Shape shape;
  std::uint8_t length;  ///< tetrahedra of a fan; 1 for elements
  std::uint16_t law;    ///< index of its LawView
  std::uint32_t batches;
  std::uint32_t first_index;  ///< in Block::index
  std::uint32_t first_slot;   ///< in Block::secant
};

/// What the tangent keeps of a point besides g.
inline constexpr int tangent_floats = 5;

/// What the nonlinear pass leaves to others, all as `secant` below: where `strain` is not null it leaves
/// ‖dev ε‖ there and no stress; where `secant` is not null g, dg/dx and G are these and no law is asked.
template <class Real>
struct Outside {
  Real* strain = nullptr;
  const Real* secant = nullptr;
  const Real* slope = nullptr;   ///< null: 0
  const Real* energy = nullptr;  ///< null: 0

  /// The same from a later place in the arrays on.
  Outside from(std::size_t offset) const {
    const auto later = [offset](auto* array) { return array == nullptr ? nullptr : array + offset; };
    return {later(strain), later(secant), later(slope), later(energy)};
  }
};

/// Local nodes are records of four values, the last one unused, but for corners round which tr ε is averaged:
/// there the mean goes in, and the volume change comes out (theory: displacement-pressure); of axisymmetric
/// coordinates the third is the radius. `index` holds, batch by batch, node by node, lane by lane, the offset
/// of a record (four times the local node). `secant` holds, batch by batch, point by point, lane by lane, g;
/// `tangent` as many vectors (xx yy xy yz zx, see material.hpp) as tangent_floats for each.
template <class Real>
struct Block {
  const Group* groups;
  std::size_t group_count;
  const LawView* laws;
  const std::uint16_t* index;
  const Real* coordinates;
  Real* secant;
  float* tangent;
  const std::int32_t* nodes;   ///< the caller's number of every local node; `nodes_ahead` more may be read
  const std::int32_t* shared;  ///< slot in the thread's private sums, for nodes from `again` on
  std::uint32_t first;         ///< local nodes [0, first) are met for the first time by this thread
  std::uint32_t again;         ///< [first, again) were met before, [again, count) are other threads' too
  std::uint32_t count;
  std::uint32_t placed[3];  ///< how many of these three, from the beginning of each, have coordinates read
  std::uint32_t padding;    ///< records behind `count` that lanes without a unit work on
  PlaneState plane = PlaneState::strain;
  const Real* free_strain = nullptr;  ///< as `secant`, in plane stress; null: 0
  Outside<Real> outside = {};
};

/// How far the copies between vectors and records fetch ahead.
inline constexpr int nodes_ahead = 64;

/// Tetrahedra of the longest fan: the loops keep the geometry of a batch of them.
inline constexpr int longest_fan = 16;

/// What the nonlinear pass leaves behind, besides forces.
struct Nonlinear {
  bool keep_secant = false;
  bool keep_tangent = false;
  bool sum_energy = false;
  /// Added to, lane by lane: one number that lanes were added to in turn made each wait for the one before.
  alignas(64) double energies[16] = {};

  double energy() const {
    double sum = 0.0;
    for (const double lane : energies) sum += lane;
    return sum;
  }
};

/// Input vectors on the records of a block and, for each, what is added to: `count` of them (1, 2 or 4),
/// `stride` values apart in u and in f.
template <class Real>
struct Vectors {
  const Real* u;
  Real* f;
  int count = 1;
  std::size_t stride = 0;
};

/// The loops of one instruction set. `u` and `f` are records of local nodes; `dim` 2 or 3.
template <class Real>
struct Kernels {
  int lanes;
  /// u = x at the block's nodes, f = 0.
  void (*gather)(const Block<Real>&, int dim, const Real* x, Real* u, Real* f);
  /// y = f or y += f at the block's nodes, private sums += f for shared ones.
  void (*scatter)(const Block<Real>&, int dim, const Real* f, Real* y, Real* sums);
  /// Σ uᵀ f over the block's local nodes.
  double (*dot)(const Block<Real>&, const Real* u, const Real* f);
  /// The last places of f += ∫ N tr ε(u) at corners round which tr ε is averaged.
  void (*corner_changes)(const Block<Real>&, const Vectors<Real>&);
  /// f += ∫ p ∇N of the p in the last places of u at corners round which tr ε is averaged: the transpose.
  void (*corner_forces)(const Block<Real>&, const Vectors<Real>&);
  /// f += B u.
  void (*apply)(const Block<Real>&, const Vectors<Real>&);
  /// f += B_T u.
  void (*apply_tangent)(const Block<Real>&, const Vectors<Real>&);
  /// f += internal force of the true law at u.
  void (*nonlinear)(const Block<Real>&, const Real* u, Real* f, Nonlinear*);
};

}  // namespace kacanov::simd
