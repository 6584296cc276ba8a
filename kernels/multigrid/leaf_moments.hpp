// SPDX-License-Identifier: BSD-3-Clause
// What the displacement–pressure form on a tree's leaves is made of (theory: background-grid).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "multigrid/grid_vertices.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/node_block.hpp"

namespace kacanov {

/// Whose volume changes have pressures: those of elements that average tr ε, or of all.
enum class VolumeOf { averaging, all };

/// What a node stands for: integrals over its shares of the elements here. `bulk`: of k0 where there is no
/// pressure; where there is one, of 1 (`volume`) and of 1/k0 (`compliance`).
struct NodeMeasure {
  double shear = 0.0, bulk = 0.0, volume = 0.0, compliance = 0.0;
};

/// Of every node, elements shared evenly among their nodes; g: elements × points.
std::vector<NodeMeasure> node_measures(const Body& body, std::span<const double> g, VolumeOf volume,
                                       int threads);

/// Integrals over a leaf of l₀², l₀l₁, l₁² along each axis times a weight, l₀ = 1 − ξ and l₁ = ξ: of their
/// sums all products of two trilinear functions and their derivatives consist.
using Moments = std::array<double, 27>;

struct LeafMoments {
  Moments shear{}, bulk{}, volume{}, compliance{};
};

/// Of stiffnesses: xx, xy, xz, yy, yz, zz.
using StiffnessMoments = std::array<Moments, 6>;

/// The leaves of one level of a tree that have nodes of this rank in them.
struct GridLeaves {
  std::vector<std::int32_t> cell;   ///< ascending
  std::vector<std::int32_t> above;  ///< on the next level: which leaf each one is part of
};

/// Level by level, up to `last`; `cell`: the deepest, of every node.
std::vector<GridLeaves> leaves_of_levels(const GridTree& tree, std::span<const std::int32_t> cell, int last);

/// Stiffnesses of nodes, of a level's leaves.
struct LevelStiffness {
  std::vector<std::int32_t> stiff;  ///< of every leaf: which of `stiffness` it has, −1 for none
  std::vector<StiffnessMoments> stiffness;
};

/// Moments of a level's leaves.
struct LevelMoments : LevelStiffness {
  std::vector<LeafMoments> leaf;
};

/// The nodes of this rank and where in the deepest leaves they are.
struct NodesInTree {
  std::span<const double> coordinates;  ///< nodes × 3
  std::span<const std::int32_t> cell;   ///< of every node
};

/// Of the deepest leaves; `blocks` are stiffnesses of nodes.
LevelMoments level_moments(const GridTree& tree, const GridLeaves& leaves, const NodesInTree& nodes,
                           std::span<const NodeMeasure> measures, std::span<const NodeBlock> blocks,
                           int threads);

/// The same without the elements.
LevelStiffness level_stiffness(const GridTree& tree, const GridLeaves& leaves, const NodesInTree& nodes,
                               std::span<const NodeBlock> blocks);

/// Of the next level, `coarse`.
LevelMoments raised(const GridTree& tree, const GridLeaves& fine, const GridLeaves& coarse,
                    const LevelMoments& moments);
LevelStiffness raised(const GridTree& tree, const GridLeaves& fine, const GridLeaves& coarse,
                      const LevelStiffness& moments);

}  // namespace kacanov
