// SPDX-License-Identifier: BSD-3-Clause
// Moments of an octree's leaves, and the displacement–pressure form computed from them (theory:
// background-grid).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "multigrid/multigrid_body.hpp"
#include "multigrid/octree/octree.hpp"

namespace kacanov {

/// Elements whose volume changes have pressures: those that average tr ε, or all.
enum class VolumeOf { averaging, all };

/// Integrals over a node's shares of the elements on this rank: of g (`shear`) and, where there is no
/// pressure, of k0 (`bulk`); where there is one, of 1 (`volume`) and of 1/k0 (`compliance`).
struct NodeMeasure {
  double shear = 0.0, bulk = 0.0, volume = 0.0, compliance = 0.0;
};

/// Measures of every node; elements are divided equally among their nodes; `g`: elements × points.
std::vector<NodeMeasure> node_measures(const Body& body, std::span<const double> g, VolumeOf volume,
                                       int threads);

/// Integrals over a leaf of a weight times l₀², l₀l₁, l₁² along each axis, l₀ = 1 − ξ and l₁ = ξ: all
/// products of two trilinear functions and their derivatives are sums of them.
using Moments = std::array<double, 27>;

struct CellMoments {
  Moments shear{}, bulk{}, volume{}, compliance{};
};

/// Moments of stiffnesses: xx, xy, xz, yy, yz, zz.
using StiffnessMoments = std::array<Moments, 6>;

/// The leaves of one level of a tree that have nodes of this rank in them.
struct OctreeLeaves {
  std::vector<std::int32_t> cell;   ///< ascending
  std::vector<std::int32_t> above;  ///< per leaf: index of the leaf on the next level that contains it
};

/// Leaves of all levels up to `last`; `cell`: deepest leaf of every node.
std::vector<OctreeLeaves> leaves_of_levels(const Octree& tree, std::span<const std::int32_t> cell, int last);

/// Stiffnesses of nodes in the leaves of a level.
struct LevelStiffness {
  std::vector<std::int32_t> stiff;  ///< per leaf: index into `stiffness`, −1 for none
  std::vector<StiffnessMoments> stiffness;
};

/// Moments of a level's leaves.
struct LevelMoments : LevelStiffness {
  std::vector<CellMoments> leaf;
};

/// The nodes of this rank and the deepest leaves that contain them.
struct NodesInTree {
  std::span<const double> coordinates;  ///< nodes × 3
  std::span<const std::int32_t> cell;   ///< per node
};

/// Moments of the deepest leaves; `blocks`: stiffnesses of nodes.
LevelMoments level_moments(const Octree& tree, const OctreeLeaves& leaves, const NodesInTree& nodes,
                           std::span<const NodeMeasure> measures, std::span<const NodeBlock> blocks,
                           int threads);

/// Moments of the stiffnesses only.
LevelStiffness level_stiffness(const Octree& tree, const OctreeLeaves& leaves, const NodesInTree& nodes,
                               std::span<const NodeBlock> blocks);

/// Moments of the next level, `coarse`.
LevelMoments raised(const Octree& tree, const OctreeLeaves& fine, const OctreeLeaves& coarse,
                    const LevelMoments& moments);
LevelStiffness raised(const Octree& tree, const OctreeLeaves& fine, const OctreeLeaves& coarse,
                      const LevelStiffness& moments);

/// [A Bᵀ; B −C] of a leaf's eight corner functions: blocks of three displacements and the pressure, rows of
/// four. −C includes a stabilisation of pressures that alternate between corners, which trilinear
/// displacements do not see: besides p²/k0 they store (p − p̄)²/2g, p̄ and g averaged over the leaf (Dohrmann
/// and Bochev, Int. J. Numer. Meth. Fluids 46 (2004) 183–201).
class CellStiffness {
 public:
  using Block = std::array<double, 16>;

  /// `stiffness` may be null.
  CellStiffness(const CellMoments& moments, const StiffnessMoments* stiffness, double length);
  /// Row i, column j.
  const Block& block(std::size_t i, std::size_t j) const { return block_[8 * i + j]; }

 private:
  void add_stiffness(const StiffnessMoments& stiffness);
  void add_stabilisation(const std::array<double, 64>& mass, double softness);
  void mirror();

  std::array<Block, 64> block_;
};

}  // namespace kacanov
