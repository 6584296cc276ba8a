// SPDX-License-Identifier: BSD-3-Clause
// What the control groups of this process leave it of the machine, in versions 1 and 2, nested ones included.
#pragma once

#include <cmath>
#include <filesystem>
#include <istream>

namespace kacanov {

/// Infinite where nothing is limited.
struct ControlGroupLimits {
  double cores = HUGE_VAL;   ///< processor time a time
  double memory = HUGE_VAL;  ///< bytes that are left: the limit less what is in use and cannot be reclaimed
};

/// The narrowest limits of the groups that `membership` (a /proc/PID/cgroup) names and of all those above
/// them. `mounted` is where the hierarchies are mounted; what is not there limits nothing.
ControlGroupLimits control_group_limits(std::istream& membership, const std::filesystem::path& mounted);

/// Those of this process.
ControlGroupLimits control_group_limits();

}  // namespace kacanov
