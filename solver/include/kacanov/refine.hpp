// SPDX-License-Identifier: BSD-3-Clause
// Uniform refinement of a mesh.
#pragma once

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Halves every edge: 4 children an element in 2D, 8 in 3D, element e's being 8e … 8e + 7. The coarse nodes
/// keep their numbers and tags, new ones follow. Edges with nodes in their middles keep their curves;
/// tetrahedra are cut along the shortest diagonal inside. Groups of elements and facets become those of their
/// children, of lines on which nodes lie those with the nodes in the middle; element numbers of a file are
/// lost. Throws InputError where the nodes no longer fit 32-bit indices.
Mesh refine(const Mesh& mesh);

}  // namespace kacanov
