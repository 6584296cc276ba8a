// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement of a mesh.
#pragma once

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Halves every edge: 4 children per element in 2D, 8 in 3D; the children of element e are 8e … 8e + 7 (4e …
/// 4e + 3). Coarse nodes keep their numbers and tags, and new nodes follow. Edges with mid-side nodes keep
/// their curves; tetrahedra are split along the shortest inner diagonal. Groups of elements and facets then
/// contain the children, groups of nodes that cover edges also the new nodes on them; element numbers of the
/// mesh file are lost. Throws InputError if the number of nodes exceeds 32-bit indices.
Mesh refine(const Mesh& mesh);

}  // namespace kacanov
