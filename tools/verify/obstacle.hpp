// SPDX-License-Identifier: BSD-3-Clause
// How a node faces an obstacle (theory: traces, surface-distance).
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Facing {
  Vec normal{};  ///< ν
  Real gap = 0;
  bool missed = false;
  bool grazing = false;  ///< whether it is met is a matter of rounding
  Real unknown = 0;      ///< what arithmetic leaves of the gap
};

/// Of a node at x with the body's outer normal (of any length) there.
using Face = std::function<Facing(const Vec& x, const Vec& outer)>;

/// Of an `obstacle` of a case; its file is read. Throws Failure.
Face read_obstacle(const nlohmann::json& obstacle, const std::filesystem::path& folder);

/// Corners of the triangles of an STL file.
using Triangle = std::array<Vec, 3>;
std::vector<Triangle> read_stl(const std::filesystem::path& file);
/// Of the facets of a Gmsh file, those of one group or, where it is empty, all.
std::vector<Triangle> read_gmsh_facets(const std::filesystem::path& file, const std::string& group);

}  // namespace kacanov::verify
