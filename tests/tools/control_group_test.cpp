// SPDX-License-Identifier: BSD-3-Clause
// Limits of control groups, from files as in Linux's versions 1 and 2.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "program/control_group.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using kacanov::testing::TemporaryFolder;

namespace {

void put(const TemporaryFolder& folder, const std::string& file, const char* text) {
  const std::filesystem::path path = folder.file(file);
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

ControlGroupLimits limits(const TemporaryFolder& folder, const char* membership) {
  std::istringstream stream(membership);
  return control_group_limits(stream, folder.file(""));
}

}  // namespace

TEST_CASE("no files, no limits") {
  const TemporaryFolder folder;
  const ControlGroupLimits none = limits(folder, "0::/a/b\n4:memory:/c\nnonsense\n");
  CHECK(std::isinf(none.cores));
  CHECK(std::isinf(none.memory));
}

TEST_CASE("version 2: the narrowest of the groups above counts, and what can be reclaimed is free") {
  const TemporaryFolder folder;
  put(folder, "cpu.max", "max 100000\n");
  put(folder, "a/cpu.max", "150000 100000\n");
  put(folder, "a/b/cpu.max", "400000 100000\n");
  put(folder, "a/memory.max", "1000000\n");
  put(folder, "a/memory.current", "600000\n");
  put(folder, "a/memory.stat", "anon 5\ninactive_file 250000\n");
  put(folder, "a/b/memory.max", "max\n");
  const ControlGroupLimits found = limits(folder, "0::/a/b\n");
  CHECK(found.cores == doctest::Approx(1.5));
  CHECK(found.memory == doctest::Approx(650000));
  // Of another container's group only the mounted root is visible.
  CHECK(std::isinf(limits(folder, "0::/elsewhere\n").cores));
}

TEST_CASE("version 1: controllers of their own, −1 for none") {
  const TemporaryFolder folder;
  put(folder, "cpu,cpuacct/x/cpu.cfs_quota_us", "50000\n");
  put(folder, "cpu,cpuacct/x/cpu.cfs_period_us", "100000\n");
  put(folder, "cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  put(folder, "cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  put(folder, "memory/x/memory.limit_in_bytes", "800\n");
  put(folder, "memory/x/memory.usage_in_bytes", "900\n");
  put(folder, "memory/x/memory.stat", "total_inactive_file 300\n");
  const ControlGroupLimits found = limits(folder, "5:cpu,cpuacct:/x\n4:memory:/x\n0::/\n");
  CHECK(found.cores == doctest::Approx(0.5));
  CHECK(found.memory == doctest::Approx(200));
}
