// SPDX-License-Identifier: BSD-3-Clause
// Reads a mesh file of any supported format.
#pragma once

#include <string>
#include <string_view>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Mesh file formats, recognised by content.
enum class MeshFormat { gmsh, deck, vtu };

/// Returns the format of a file. Throws InputError naming the apparent format if it is known but not
/// supported.
MeshFormat format_of(const std::string& path, std::string_view bytes);

/// Reads a Gmsh mesh, the mesh of an Abaqus or CalculiX deck, or the grid of a VTK file (.vtu). Throws
/// InputError naming the file and the place in it. Elements are not checked yet: see check_mesh().
Mesh read_mesh(const SourceFile& source);
/// Parses the bytes of a file; a deck in memory cannot include files.
Mesh read_mesh(const SourceFile& name, std::string_view bytes);

}  // namespace kacanov
