// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh file section by section: formats 2.2 and 4.1, ASCII and binary.
#pragma once

#include <string>
#include <string_view>

#include "formats/mesh_content.hpp"

namespace kacanov {

/// `bytes` is the whole file, `path` its name in messages.
/// Throws InputError naming the line (ASCII) or byte (binary) of what is wrong.
MeshContent parse_gmsh(const std::string& path, std::string_view bytes);

}  // namespace kacanov
