// SPDX-License-Identifier: BSD-3-Clause
// Writes a mesh with its groups, as Gmsh or as Abaqus and CalculiX read it.
#pragma once

#include <string>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// A Gmsh file of format 4.1, ASCII, with the numbers of nodes and elements and all groups. Throws
/// InternalError where it cannot be written.
void write_gmsh(const std::string& path, const Mesh& mesh);

/// The nodes and elements of a deck; groups are element sets, surfaces, and node sets. Throws InternalError
/// likewise.
void write_deck(const std::string& path, const Mesh& mesh);

}  // namespace kacanov
