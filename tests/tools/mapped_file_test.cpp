// SPDX-License-Identifier: BSD-3-Clause
// A mapped file that is truncated while it is read, and atomic files whose temporary name is a symbolic link.
#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"
#include "formats/mapped_file.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using kacanov::testing::TemporaryFolder;

TEST_CASE("a mapped file that is cut reads as zeros and says so") {
  const TemporaryFolder folder;
  const std::string path = folder.file("mesh.msh");
  std::ofstream(path) << std::string(1 << 20, 'x');
  const MappedFile file(path);
  CHECK_NOTHROW(file.check_unchanged());
  std::filesystem::resize_file(path, 4096);
  const auto bytes = file.bytes();
  CHECK(std::accumulate(bytes.begin(), bytes.end(), 0LL) == 4096LL * 'x');
  CHECK_THROWS_WITH_AS(file.check_unchanged(),
                       doctest::Contains("was changed while it was read (1048576 bytes"), InputError);
}

TEST_CASE("an atomic file does not follow a link under its temporary name") {
  const TemporaryFolder folder;
  const auto victim = folder.file("victim"), target = folder.file("result.json");
  std::ofstream(victim) << "kept";
  std::filesystem::create_symlink(victim, target + ".part" + std::to_string(::getpid()));
  write_file(target, "new");
  std::string text;
  std::ifstream(victim) >> text;
  CHECK(text == "kept");
  std::ifstream(target) >> text;
  CHECK(text == "new");
  CHECK_FALSE(std::filesystem::is_symlink(target));
}
