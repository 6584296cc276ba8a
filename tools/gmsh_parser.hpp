// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh file section by section: formats 2.2 and 4.1, ASCII and binary.
#pragma once

#include <string>

#include "gmsh_content.hpp"

namespace kacanov {

/// Throws InputError naming the line (ASCII) or byte (binary) of what is wrong.
GmshContent parse_gmsh(const std::string& path);

}  // namespace kacanov
