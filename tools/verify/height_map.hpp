// SPDX-License-Identifier: BSD-3-Clause
// Reads obstacles from files: height maps, and triangles of STL and Gmsh.
#pragma once

#include "verify/obstacle.hpp"

namespace kacanov::verify {

/// Reads the `height_map` of a case: CSV, PBM, PGM, PNG.
Face read_height_map(const nlohmann::json& given, const std::filesystem::path& folder);

/// Returns whether a file is in Gmsh's format.
bool starts_with_dollar(const std::filesystem::path& file);

}  // namespace kacanov::verify
