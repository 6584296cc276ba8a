// SPDX-License-Identifier: BSD-3-Clause
// Checks that readers of meshes refuse an input with a message, or return a mesh of valid indices.
// indices.
#pragma once

#include <algorithm>
#include <span>

#include <kacanov/error.hpp>
#include <kacanov/mesh.hpp>
#include "bytes.hpp"

namespace kacanov::fuzz {

inline bool within(std::span<const std::int32_t> indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](std::int32_t i) { return i >= 0 && static_cast<std::size_t>(i) < count; });
}

/// Calls `read` and checks the mesh that it returns.
template <class Read>
void read_mesh(const Read& read) {
  try {
    const Mesh mesh = read();
    const std::size_t nodes = mesh.node_count();
    expect(within(mesh.elements, nodes) && within(mesh.facets, nodes) &&
           within(mesh.facet_element, mesh.element_count()));
    for (const Group& group : mesh.groups)
      expect(within(group.members, group.dimension == mesh.dim()       ? mesh.element_count()
                                   : group.dimension == mesh.dim() - 1 ? mesh.facet_count()
                                                                       : nodes));
    check_mesh(mesh);
  } catch (const InputError&) {
  }
}

}  // namespace kacanov::fuzz
