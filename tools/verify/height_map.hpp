// SPDX-License-Identifier: BSD-3-Clause
// Files of obstacles: height maps and STL.
#pragma once

#include "verify/obstacle.hpp"

namespace kacanov::verify {

/// Of a case's `height_map`: CSV, PBM, PGM, PNG.
Face read_height_map(const nlohmann::json& given, const std::filesystem::path& folder);

/// Whether a file is Gmsh's.
bool starts_with_dollar(const std::filesystem::path& file);

}  // namespace kacanov::verify
