// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh mesh: the elements of the highest dimension form the body, physical groups its named parts.
#pragma once

#include <string_view>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Reads format 2.2 or 4.1, ASCII or binary. A 2D mesh must lie in a plane z = constant. The body consists of
/// all elements of the highest dimension, of one ElementType, whether or not they are in a physical group.
/// Groups of the body's dimension become element groups, those one dimension lower become facet groups
/// (boundary facets only), and the others node groups; an unnamed group is named by its number. Elements are
/// not checked yet: see check_mesh(). Throws InputError: `path: line N: ...` (ASCII), `path: byte N: ...`
/// (binary), or naming the element or node.
Mesh read_gmsh(const SourceFile& source);
/// Parses the bytes of a file; `name` replaces its path in messages.
Mesh read_gmsh(const SourceFile& name, std::string_view bytes);

}  // namespace kacanov
