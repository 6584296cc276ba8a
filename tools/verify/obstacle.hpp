// SPDX-License-Identifier: BSD-3-Clause
// Gap and normal between a node and an obstacle (theory: traces, surface-distance).
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
  bool grazing = false;  ///< round-off decides whether the obstacle is hit
  Real unknown = 0;      ///< round-off of the gap
};

/// Returns the gap and normal for a node at x, given the body's outward normal there, of any length.
using Face = std::function<Facing(const Vec& x, const Vec& outer)>;

/// Reads an `obstacle` of a case, including its file. Throws Failure.
Face read_obstacle(const nlohmann::json& obstacle, const std::filesystem::path& folder);

/// Returns the corners of the triangles of an STL file.
using Triangle = std::array<Vec, 3>;
std::vector<Triangle> read_stl(const std::filesystem::path& file);
/// Returns the facets of a Gmsh file as triangles: those of `group`, or all if it is empty.
std::vector<Triangle> read_gmsh_facets(const std::filesystem::path& file, const std::string& group);

}  // namespace kacanov::verify
