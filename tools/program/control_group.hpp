// SPDX-License-Identifier: BSD-3-Clause
// Limits of Linux control groups on this process, versions 1 and 2, including parent groups.
#pragma once

#include <cmath>
#include <filesystem>
#include <istream>

namespace kacanov {

/// Infinite if there is no limit.
struct ControlGroupLimits {
  double cores = HUGE_VAL;   ///< processor seconds per second
  double memory = HUGE_VAL;  ///< free bytes: the limit minus memory in use that cannot be reclaimed
};

/// Returns the tightest limits of the groups listed in `membership` (a /proc/PID/cgroup) and of their
/// parents. `mounted` is where the hierarchies are mounted; missing files count as no limit.
ControlGroupLimits control_group_limits(std::istream& membership, const std::filesystem::path& mounted);

/// Limits of this process.
ControlGroupLimits control_group_limits();

}  // namespace kacanov
