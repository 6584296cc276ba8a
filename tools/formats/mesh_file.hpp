// SPDX-License-Identifier: BSD-3-Clause
// Reads a mesh of whatever format its file is in.
#pragma once

#include <string>
#include <string_view>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Formats of mesh files, told apart by what is in them.
enum class MeshFormat { gmsh, deck, vtu };

/// Throws InputError saying what the file seems to be, where it is of a format that is known and not read.
MeshFormat format_of(const std::string& path, std::string_view bytes);

/// Reads a Gmsh mesh, the mesh of an Abaqus or CalculiX deck, or the grid of a VTK file (.vtu). Throws
/// InputError naming the file and the place in it. Elements are not yet checked: see check_mesh.
Mesh read_mesh(const SourceFile& source);
/// The same from the bytes of a file; a deck may include no others then.
Mesh read_mesh(const SourceFile& name, std::string_view bytes);

}  // namespace kacanov
