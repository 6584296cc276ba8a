// SPDX-License-Identifier: BSD-3-Clause
// From the caller's element nodes, in whatever order and sense, to ours; and the nodes of no element.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <kacanov/mesh_view.hpp>

namespace kacanov::c_api {

/// The caller's node k of an element is ours of number order[k]; empty where they are the same. Throws Fault
/// for a name that is none, and for an order that the element does not have.
std::vector<std::int8_t> node_order(const char* name, ElementType type);

/// Renumbers the nodes of elements that are the wrong way round everywhere. Indices have been checked.
void turn_inverted(const MeshView& mesh, std::span<std::int32_t> connectivity);

/// Nodes of no element, ascending.
std::vector<std::int32_t> orphans(const MeshView& mesh);

}  // namespace kacanov::c_api
