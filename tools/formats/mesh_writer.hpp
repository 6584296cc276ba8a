// SPDX-License-Identifier: BSD-3-Clause
// Writes a mesh with its groups as a Gmsh file or as a deck for Abaqus and CalculiX.
#pragma once

#include <string>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Writes a Gmsh file of format 4.1, ASCII, with node and element numbers and all groups. Throws
/// InternalError if writing fails.
void write_gmsh(const std::string& path, const Mesh& mesh);

/// Writes the nodes and elements of a deck; groups become element sets, surfaces and node sets. Throws
/// InternalError if writing fails.
void write_deck(const std::string& path, const Mesh& mesh);

}  // namespace kacanov
