// SPDX-License-Identifier: BSD-3-Clause
// Finer meshes of a file's: every edge halved, and a node in the middle of every straight edge (user guide:
// refine, order).
#pragma once

#include "verify/mesh.hpp"

namespace kacanov::verify {

/// New nodes are numbered after the largest number, as they are met: element by element, child by child,
/// corner by corner, those of a child's edges last. Facets are left to be found.
Mesh halved(const Mesh& mesh);
/// tet10 of tet4, with straight edges.
Mesh raised(const Mesh& mesh);

}  // namespace kacanov::verify
