// SPDX-License-Identifier: BSD-3-Clause
// Conversion of the caller's element nodes, in any order and orientation; and nodes that belong to no
// element.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <kacanov/mesh_view.hpp>

namespace kacanov::c_api {

/// Returns the permutation of nodes: the caller's node k of an element is node order[k] here; empty for the
/// identity. Throws Fault for an unknown name, and for an order that does not exist for the element.
std::vector<std::int8_t> node_order(const char* name, ElementType type);

/// Renumbers the nodes of elements that are inverted at all points. Indices must have been checked.
void turn_inverted(const MeshView& mesh, std::span<std::int32_t> connectivity);

/// Nodes that belong to no element, ascending.
std::vector<std::int32_t> orphans(const MeshView& mesh);

}  // namespace kacanov::c_api
