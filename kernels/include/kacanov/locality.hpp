// SPDX-License-Identifier: BSD-3-Clause
// Orderings of nodes and elements that keep neighbours close in memory.
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

/// Orders nodes along a Hilbert curve over coordinates scaled by the average extents of an element, so that
/// flat or stretched elements keep their neighbours; orders elements by their first node on the curve. The
/// operator is fastest on a mesh renumbered this way: its copies to and from the caller's vectors become
/// nearly sequential.
LocalityOrder locality_order(const MeshView& mesh);

/// The `nodes` part of locality_order().
std::vector<std::int32_t> node_order(const MeshView& mesh);

/// Splits nodes into `parts` compact sets with METIS, which works on groups of nodes consecutive in `order`
/// (a node order as above). Returns the part of each node; consecutive parts tend to be neighbours.
std::vector<std::int32_t> partition_nodes(const MeshView& mesh, std::span<const std::int32_t> order,
                                          int parts);

}  // namespace kacanov
