// SPDX-License-Identifier: BSD-3-Clause
// Reads the limits of Linux control groups.
#include "program/control_group.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {
namespace {

namespace fs = std::filesystem;

/// Returns the first number in a file; nothing if there is none ("max").
std::optional<double> number_in(const fs::path& file) {
  PlainFile stream(file);
  double value = 0.0;
  if (stream >> value) return value;
  return std::nullopt;
}

/// Returns the number after a word in a file of word-number pairs; 0 if it is missing.
double number_behind(const std::string& word, const fs::path& file) {
  PlainFile stream(file);
  std::string key;
  for (double value = 0.0; stream >> key >> value;)
    if (key == word) return value;
  return 0.0;
}

void limit_memory(ControlGroupLimits& limits, std::optional<double> limit, const fs::path& used,
                  double reclaimable) {
  if (!limit || *limit < 0.0) return;
  const double held = number_in(used).value_or(0.0) - reclaimable;
  limits.memory = std::min(limits.memory, std::max(0.0, *limit - std::max(0.0, held)));
}

void limit_cores(ControlGroupLimits& limits, std::optional<double> quota, std::optional<double> period) {
  if (quota && period && *quota > 0.0 && *period > 0.0)
    limits.cores = std::min(limits.cores, *quota / *period);
}

/// Applies both limits of a version 2 group.
void look_at_unified(ControlGroupLimits& limits, const fs::path& group) {
  PlainFile cpu(group / "cpu.max");
  double quota = 0.0, period = 0.0;
  if (cpu >> quota >> period) limit_cores(limits, quota, period);
  limit_memory(limits, number_in(group / "memory.max"), group / "memory.current",
               number_behind("inactive_file", group / "memory.stat"));
}

void look_at_cpu(ControlGroupLimits& limits, const fs::path& group) {
  limit_cores(limits, number_in(group / "cpu.cfs_quota_us"), number_in(group / "cpu.cfs_period_us"));
}

void look_at_memory(ControlGroupLimits& limits, const fs::path& group) {
  limit_memory(limits, number_in(group / "memory.limit_in_bytes"), group / "memory.usage_in_bytes",
               number_behind("total_inactive_file", group / "memory.stat"));
}

/// Visits the group and its parents. A container may see its own group as the root, so missing folders are
/// skipped.
template <class Look>
void climb(ControlGroupLimits& limits, const fs::path& hierarchy, const std::string& group, Look&& look) {
  std::error_code ignored;
  if (!fs::is_directory(hierarchy, ignored)) return;
  look(limits, hierarchy);
  fs::path at = hierarchy;
  for (const fs::path& step : fs::path(group).relative_path()) {
    at /= step;
    if (step != "..") look(limits, at);
  }
}

}  // namespace

ControlGroupLimits control_group_limits(std::istream& membership, const fs::path& mounted) {
  ControlGroupLimits limits;
  for (std::string line; std::getline(membership, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1),
                      group = line.substr(second + 1);
    if (controllers.empty()) {
      climb(limits, mounted, group, look_at_unified);
      climb(limits, mounted / "unified", group, look_at_unified);  // version 2 mounted beside version 1
      continue;
    }
    PlainWords words(controllers);
    for (std::string word; std::getline(words, word, ',');) {
      if (word == "memory") climb(limits, mounted / controllers, group, look_at_memory);
      if (word == "cpu") climb(limits, mounted / controllers, group, look_at_cpu);
    }
  }
  return limits;
}

ControlGroupLimits control_group_limits() {
  PlainFile membership("/proc/self/cgroup");
  return control_group_limits(membership, "/sys/fs/cgroup");
}

}  // namespace kacanov
