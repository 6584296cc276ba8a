// SPDX-License-Identifier: BSD-3-Clause
// What holds nodes, as background grids have it.
#pragma once

#include <cstddef>
#include <vector>

#include "multigrid/fine_level.hpp"

namespace kacanov {

/// Of the nodes this rank owns: the fine level's blocks, held components with its diagonal, and held
/// directions with a few times what their node's elements have there in place of the stiff blocks that pin
/// them (theory: background-grid). For bodies in 3D.
std::vector<NodeBlock> grid_stiffnesses(const FineLevel& fine, std::size_t owned_nodes);

}  // namespace kacanov
