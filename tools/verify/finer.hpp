// SPDX-License-Identifier: BSD-3-Clause
// Refines the mesh of a file: halves every edge, or adds a node at the middle of every straight edge (user
// guide: refine, order).
#pragma once

#include "verify/mesh.hpp"

namespace kacanov::verify {

/// Returns the uniformly refined mesh. New nodes are numbered from the largest number on, in the order in
/// which they appear: by element, child and corner; nodes on a child's edges come last. Facets are not set.
Mesh halved(const Mesh& mesh);
/// Returns the tet10 mesh of a tet4 mesh, with straight edges.
Mesh raised(const Mesh& mesh);

}  // namespace kacanov::verify
