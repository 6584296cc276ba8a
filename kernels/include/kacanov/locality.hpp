// SPDX-License-Identifier: BSD-3-Clause
// Orders of nodes and elements that keep neighbours close in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

struct LocalityOrder {
  std::vector<std::int32_t> nodes;     ///< entry i: the old number of new node i
  std::vector<std::int32_t> elements;  ///< entry i: the old number of new element i
};

/// Nodes along a space-filling (Hilbert) curve over coordinates scaled by the mean element's extents, so that
/// flat or stretched elements keep their neighbours; elements by their first node on it. A mesh renumbered
/// like this is what the operator likes best: its copies to and from the caller's vectors become nearly
/// sequential.
LocalityOrder locality_order(const MeshView& mesh);

/// The node part of it.
std::vector<std::int32_t> node_order(const MeshView& mesh);

/// Splits nodes into `parts` compact sets with METIS, which works on groups of nodes consecutive in `order`
/// (a node order as above). Returns the part of each node; consecutive parts tend to be neighbours.
std::vector<std::int32_t> partition_nodes(const MeshView& mesh, std::span<const std::int32_t> order,
                                          int parts);

}  // namespace kacanov
