// SPDX-License-Identifier: BSD-3-Clause
// Writes meshes in every variant of Gmsh's format that the reader supports.
#pragma once

#include <string>

#include <kacanov/mesh.hpp>

namespace kacanov::testing {

struct GmshForm {
  bool new_format = true;  ///< 4.1, otherwise 2.2
  bool binary = false;
  bool parametric = false;        ///< 4.1: nodes with parametric coordinates
  bool carriage_returns = false;  ///< ASCII: Windows line ends
};

/// Returns the mesh as a Gmsh file. Elements, facets and nodes of groups are written as by Gmsh: in 4.1 under
/// entities with all their groups, in 2.2 once per group. Only elements may be without a group.
std::string gmsh_file(const Mesh& mesh, const GmshForm& form);

}  // namespace kacanov::testing
