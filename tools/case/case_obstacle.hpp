// SPDX-License-Identifier: BSD-3-Clause
// The obstacle of a contact entry.
#pragma once

#include <array>
#include <functional>

#include "case/case_file.hpp"
#include "case/json_node.hpp"

namespace kacanov {

/// Reads a vector of 2 or 3 numbers and notes it for check_dimension.
using ReadVector = std::function<Vector3(const Node&)>;

/// Reads `frame`: as many axes as the mesh has dimensions; the third of a plane is across it.
std::array<Vector3, 3> parse_axes(const Node& node, const ReadVector& vector);
/// Reads `obstacle`. Where it is in a file, that is left in `file`, its name as the case has it.
Obstacle parse_obstacle(const Node& node, const ReadVector& vector, std::optional<ObstacleFile>& file);
Motion parse_motion(const Node& node, const ReadVector& vector);
ForceControl parse_force_control(const Node& node, const ReadVector& vector);

}  // namespace kacanov
