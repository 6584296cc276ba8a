// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh file section by section: formats 2.2 and 4.1, ASCII and binary.
#pragma once

#include <string_view>

#include "formats/mesh_content.hpp"
#include "formats/source_file.hpp"

namespace kacanov {

/// `bytes` is the whole file, `source` its name in messages.
/// Throws InputError naming the line (ASCII) or byte (binary) of what is wrong.
MeshContent parse_gmsh(const SourceFile& source, std::string_view bytes);

}  // namespace kacanov
