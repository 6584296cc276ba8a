// SPDX-License-Identifier: BSD-3-Clause
// Supports of nodes for background grids.
#pragma once

#include <cstddef>
#include <vector>

#include "multigrid/fine_level.hpp"

namespace kacanov {

/// Stiffnesses of the nodes that this rank owns: the fine level's blocks; at held components its diagonal; in
/// held directions a few times the stiffness of their node's elements, instead of the stiff blocks that fix
/// them (theory: background-grid). For bodies in 3D.
std::vector<NodeBlock> grid_stiffnesses(const FineLevel& fine, std::size_t owned_nodes);

}  // namespace kacanov
