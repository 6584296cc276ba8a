// SPDX-License-Identifier: BSD-3-Clause
// Quadratic elements from linear ones.
#pragma once

#include <kacanov/mesh.hpp>

namespace kacanov {

/// tet10 of a tet4 mesh: a node in the middle of every edge, which stays straight. Elements keep their order
/// and numbers, nodes theirs, new ones follow. Groups stay, of lines on which nodes lie with the nodes in the
/// middle. Throws InputError for other elements, and where nodes no longer fit 32-bit indices.
Mesh raise_order(const Mesh& mesh);

/// The element of which raise_order() makes meshes of this one. Throws InputError where there is none.
ElementType raised(ElementType type);

}  // namespace kacanov
