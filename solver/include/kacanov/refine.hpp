// SPDX-License-Identifier: BSD-3-Clause
// Refinement of a mesh: uniform, or of marked elements by bisection; and conversion of linear to quadratic
// elements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Halves every edge: 4 children per element in 2D, 8 in 3D; the children of element e are 8e … 8e + 7 (4e …
/// 4e + 3). Coarse nodes keep their numbers and tags, and new nodes follow. Edges with mid-side nodes keep
/// their curves; tetrahedra are split along the shortest inner diagonal. Groups of elements and facets then
/// contain the children, groups of nodes that cover edges also the new nodes on them; element numbers of the
/// mesh file are lost. Throws InputError if the number of nodes exceeds 32-bit indices.
Mesh refine(const Mesh& mesh);

/// Whether bisect() supports elements of this type: simplices only.
bool can_bisect(ElementType type);
/// Throws InputError if bisect() does not support this type.
void refuse_to_bisect(ElementType type);

/// Halves every edge of the `marked` elements (indices), and splits neighbours as far as needed to keep the
/// mesh conforming and well shaped (theory: bisection). Nodes keep their numbers and tags, and new nodes
/// follow, except that mid-side nodes of curved edges become corners. Groups then contain the children;
/// element numbers of the mesh file are lost. Throws InputError if the number of nodes exceeds 32-bit
/// indices.
Mesh bisect(const Mesh& mesh, std::span<const std::int32_t> marked);

/// Returns the smallest set of elements that holds `share` of the sum of `energy`, one number ≥ 0 per
/// element, as in DiscretisationError (theory: bisection).
std::vector<std::int32_t> worst_elements(std::span<const double> energy, double share);

/// Returns the tet10 mesh of a tet4 mesh, with mid-side nodes on all edges; edges stay straight. Elements and
/// nodes keep their order and numbers, and new nodes follow. Groups are kept; groups of nodes that cover
/// edges also get the mid-side nodes. Throws InputError for other element types, and if the number of nodes
/// exceeds 32-bit indices.
/// of nodes exceeds 32-bit indices.
Mesh raise_order(const Mesh& mesh);

/// Returns the element type that raise_order() converts `type` to. Throws InputError if there is no such
/// type.
ElementType raised(ElementType type);

}  // namespace kacanov
