// SPDX-License-Identifier: BSD-3-Clause
// Writes a mesh in every form of Gmsh's format that the reader has to read.
#pragma once

#include <string>

#include <kacanov/mesh.hpp>

namespace kacanov::testing {

struct GmshForm {
  bool new_format = true;  ///< 4.1, else 2.2
  bool binary = false;
  bool parametric = false;        ///< 4.1: nodes with parameters
  bool carriage_returns = false;  ///< ASCII: Windows line ends
};

/// Elements, facets and nodes that belong to groups are written as Gmsh does: in 4.1 under entities with all
/// their groups, in 2.2 once for every group. Elements come without a group too, facets and nodes do not.
std::string gmsh_file(const Mesh& mesh, const GmshForm& form);

}  // namespace kacanov::testing
