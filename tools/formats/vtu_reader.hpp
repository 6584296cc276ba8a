// SPDX-License-Identifier: BSD-3-Clause
// Reads the mesh of a VTK file: its grid, and the numbers and groups that its arrays tell.
#pragma once

#include <string_view>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// The whole numbers `node_id` of points and `element_id` of cells, as body.vtu has them, are those of the
/// mesh; cells' `gmsh:physical`, as meshio writes it, numbers their groups, which are named by that number.
/// `name` is the file's in messages. Throws InputError naming it and what of it is wrong.
Mesh read_vtu(const SourceFile& name, std::string_view bytes);

}  // namespace kacanov
