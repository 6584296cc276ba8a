// SPDX-License-Identifier: BSD-3-Clause
// Conversion of linear to quadratic elements.
#pragma once

#include <kacanov/mesh.hpp>

namespace kacanov {

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
