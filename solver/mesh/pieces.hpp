// SPDX-License-Identifier: BSD-3-Clause
// Connected components of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Components of elements connected by shared nodes, numbered in the order of their first elements.
struct MeshPieces {
  std::int32_t count = 0;
  std::vector<std::int32_t> of_node;  ///< −1: node of no element
};
MeshPieces connected_pieces(const Mesh& mesh);

}  // namespace kacanov
