// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh mesh: the elements of highest dimension are the body, physical groups its named parts.
#pragma once

#include <string_view>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Reads format 2.2 or 4.1, ASCII or binary. A 2D mesh has to lie in a plane z = constant. The body is all
/// elements of the highest dimension, of one ElementType only, in a physical group or not. Groups of the
/// body's dimension become element groups, those one below facet groups (only what lies on the boundary),
/// lower ones node groups; a group without a name is named by its number. Elements are not yet checked: see
/// check_mesh. Throws InputError: `path: line N: ...` (ASCII), `path: byte N: ...` (binary), or naming the
/// element or node.
Mesh read_gmsh(const SourceFile& source);
/// The same from the bytes of a file; `name` takes the place of its path in messages.
Mesh read_gmsh(const SourceFile& name, std::string_view bytes);

}  // namespace kacanov
