// SPDX-License-Identifier: BSD-3-Clause
// Reads the mesh of a VTK file: its grid, and the numbers and groups stored in arrays.
#pragma once

#include <string_view>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// The integer arrays `node_id` of points and `element_id` of cells, as in body.vtu, become the numbers of
/// the mesh. The cell array `gmsh:physical`, as written by meshio, gives the groups, named by number. `name`
/// names the file in messages. Throws InputError naming the file and the error.
Mesh read_vtu(const SourceFile& name, std::string_view bytes);

}  // namespace kacanov
