// SPDX-License-Identifier: BSD-3-Clause
// Parses the obstacle of a contact entry.
#pragma once

#include <array>
#include <functional>

#include "case/case_file.hpp"
#include "case/json_node.hpp"

namespace kacanov {

/// Reads a vector of 2 or 3 numbers and records it for check_dimension().
using ReadVector = std::function<Vector3(const Node&)>;

/// Reads `frame`: one axis per dimension of the mesh; in 2D the third axis is normal to the plane.
std::array<Vector3, 3> parse_axes(const Node& node, const ReadVector& vector);
/// Reads `obstacle`. If its geometry is in a file, sets `file`, with the file name as the case gives it.
Obstacle parse_obstacle(const Node& node, const ReadVector& vector, std::optional<ObstacleFile>& file);
Motion parse_motion(const Node& node, const ReadVector& vector);
ForceControl parse_force_control(const Node& node, const ReadVector& vector);

}  // namespace kacanov
