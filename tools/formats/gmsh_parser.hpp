// SPDX-License-Identifier: BSD-3-Clause
// Parses a Gmsh file section by section: formats 2.2 and 4.1, ASCII and binary.
#pragma once

#include <string_view>

#include "formats/mesh_content.hpp"
#include "formats/source_file.hpp"

namespace kacanov {

/// `bytes` is the whole file; `source` names it in messages. Throws InputError naming the line (ASCII) or
/// byte (binary) of an error.
MeshContent parse_gmsh(const SourceFile& source, std::string_view bytes);

}  // namespace kacanov
