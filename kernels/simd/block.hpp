// SPDX-License-Identifier: BSD-3-Clause
// Input of the element loops for a block: plain arrays, so that code compiled for one instruction set shares
// no inline function with code compiled for another.
#pragma once

#include <cstddef>
#include <cstdint>

#include <kacanov/mesh_view.hpp>

namespace kacanov::simd {

/// The work item in a lane: an open or closed fan of tetrahedra, or one element, which may be an affine image
/// of the reference element (a tet10 with straight edges, a hex8 that is a parallelepiped) or not.
enum class Shape : std::uint8_t { open_fan, closed_fan, affine, general };

/// The law of a group: the part that the loops evaluate themselves, and callbacks for the rest.
struct LawView {
  double bulk;           ///< k0
  double shear;          ///< g up to `elastic`
  double elastic;        ///< strain norm up to which g is constant
  bool mean_dilatation;  ///< k0 acts on an average of tr ε, over the element or around its corners
  const void* law;       ///< argument of `evaluate`
  /// Computes g and dg/dx at the strain norm x, and G unless `energy` is null.
  void (*evaluate)(const void* law, double x, double* g, double* slope, double* energy);
  /// Transverse strain at which the transverse stress vanishes (theory: plane-stress).
  double (*across)(const void* law, double xx, double yy, double xy);
};

/// Batches of one shape, length and law, with one work item per lane.
struct Group {
  ElementType type;
  Shape shape;
  std::uint8_t length;  ///< number of tetrahedra of a fan; 1 for elements
  std::uint16_t law;    ///< index of its LawView
  std::uint32_t batches;
  std::uint32_t first_index;  ///< index into Block::index
  std::uint32_t first_slot;   ///< index into Block::secant
};

/// Number of floats per point that the tangent stores besides g.
inline constexpr int tangent_floats = 5;

/// Data that the nonlinear pass exchanges with user-defined laws, laid out like Block::secant. If `strain` is
/// not null, the pass writes ‖dev ε‖ there and computes no stress; if `secant` is not null, it takes g, dg/dx
/// and G from these arrays and evaluates no law.
template <class Real>
struct Outside {
  Real* strain = nullptr;
  const Real* secant = nullptr;
  const Real* slope = nullptr;   ///< null: 0
  const Real* energy = nullptr;  ///< null: 0

  /// The same arrays, shifted by an offset.
  Outside from(std::size_t offset) const {
    const auto later = [offset](auto* array) { return array == nullptr ? nullptr : array + offset; };
    return {later(strain), later(secant), later(slope), later(energy)};
  }
};

/// Local nodes are records of four values. The last one is unused except at corners around which tr ε is
/// averaged: input is the average, output the volume change (theory: displacement-pressure). The third
/// coordinate is the radius in axisymmetric bodies. `index`: offset of each record (four times the local
/// node) by batch, node and lane. `secant`: g by batch, point and lane. `tangent`: likewise, tangent_floats
/// vectors per point (xx yy xy yz zx, see material.hpp).
template <class Real>
struct Block {
  const Group* groups;
  std::size_t group_count;
  const LawView* laws;
  const std::uint16_t* index;
  const Real* coordinates;
  Real* secant;
  float* tangent;
  const std::int32_t* nodes;   ///< the caller's number of each local node; readable for `nodes_ahead` more
  const std::int32_t* shared;  ///< slot in the thread's private sums, for nodes from `again` on
  std::uint32_t first;         ///< local nodes [0, first): used for the first time by this thread
  std::uint32_t again;         ///< [first, again): used before; [again, count): shared with other threads
  std::uint32_t count;
  std::uint32_t placed[3];  ///< nodes at the start of each of the three ranges whose coordinates are read
  std::uint32_t padding;    ///< records behind `count` for lanes without a work item
  PlaneState plane = PlaneState::strain;
  const Real* free_strain = nullptr;  ///< like `secant`, in plane stress; null: 0
  Outside<Real> outside = {};
};

/// Prefetch distance, in nodes, of the copies between vectors and records.
inline constexpr int nodes_ahead = 64;

/// Maximum number of tetrahedra of a fan: the loops store the geometry of a batch of fans.
inline constexpr int longest_fan = 16;

/// Outputs of the nonlinear pass besides forces.
struct Nonlinear {
  bool keep_secant = false;
  bool keep_tangent = false;
  bool sum_energy = false;
  /// Sums per lane: with a single sum each lane's addition waited for the previous one.
  alignas(64) double energies[16] = {};

  double energy() const {
    double sum = 0.0;
    for (const double lane : energies) sum += lane;
    return sum;
  }
};

/// `count` (1, 2 or 4) input vectors u on the records of a block and their output vectors f, `stride` values
/// apart in u and in f.
template <class Real>
struct Vectors {
  const Real* u;
  Real* f;
  int count = 1;
  std::size_t stride = 0;
};

/// The loops of one instruction set. `u` and `f` are records of local nodes; `dim` is 2 or 3.
template <class Real>
struct Kernels {
  int lanes;
  /// u = x at the block's nodes, f = 0.
  void (*gather)(const Block<Real>&, int dim, const Real* x, Real* u, Real* f);
  /// y = f or y += f at the block's nodes; for shared nodes, private sums += f.
  void (*scatter)(const Block<Real>&, int dim, const Real* f, Real* y, Real* sums);
  /// Σ uᵀ f over the block's local nodes.
  double (*dot)(const Block<Real>&, const Real* u, const Real* f);
  /// Last entry of f += ∫ N tr ε(u) at corners around which tr ε is averaged.
  void (*corner_changes)(const Block<Real>&, const Vectors<Real>&);
  /// The transpose: f += ∫ p ∇N with p in the last entries of u at these corners.
  void (*corner_forces)(const Block<Real>&, const Vectors<Real>&);
  /// f += B u.
  void (*apply)(const Block<Real>&, const Vectors<Real>&);
  /// f += B_T u.
  void (*apply_tangent)(const Block<Real>&, const Vectors<Real>&);
  /// f += internal force of the true law at u.
  void (*nonlinear)(const Block<Real>&, const Real* u, Real* f, Nonlinear*);
};

}  // namespace kacanov::simd
