// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form on the trilinear functions of a tree (theory: background-grid).
#pragma once

#include <span>
#include <vector>

#include "multigrid/grid_vertices.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/node_block.hpp"
#include "multigrid/rigid_level.hpp"

namespace kacanov {

/// What a node stands for: integrals over its shares of the elements here. `bulk`: of k0 where tr ε is not
/// averaged; where it is, of 1 (`volume`) and of 1/k0 (`compliance`).
struct NodeMeasure {
  double shear = 0.0, bulk = 0.0, volume = 0.0, compliance = 0.0;
};

/// Of every node, elements shared evenly among their nodes; g: elements × points.
std::vector<NodeMeasure> node_measures(const Body& body, std::span<const double> g);

/// The nodes of this rank and where in the deepest leaves they are.
struct NodesInTree {
  std::span<const double> coordinates;  ///< nodes × 3
  std::span<const std::int32_t> cell;   ///< of every node
};

/// [A Bᵀ; B −C] of the trilinear functions: integrands are taken at the nodes. Blocks, 4 × 4, have three
/// displacements and the pressure. `blocks` are stiffnesses of nodes.
BlockSums<4> grid_sums(const GridVertices& vertices, const NodesInTree& nodes,
                       std::span<const NodeMeasure> measures, std::span<const NodeBlock> blocks);

}  // namespace kacanov
