// SPDX-License-Identifier: BSD-3-Clause
// Preparations before MPI starts: the path of the program's own file, and a folder for Open MPI.
#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kacanov/error.hpp>
#include "program/launch.hpp"
#include "program/mpi_folder.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;
namespace fs = std::filesystem;

namespace {

/// Not even root can make a folder in /proc.
const fs::path closed = "/proc";

fs::path made_in(const fs::path& base) {
  const std::array bases{base};
  return LockedFolder(bases).path();
}

/// Returns the folder left behind by a process that was killed.
fs::path left_over(const fs::path& base) {
  const pid_t child = fork();
  if (child == 0) {
    const std::array bases{base};
    new LockedFolder(bases);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  return fs::directory_iterator(base)->path();
}

}  // namespace

TEST_CASE("a folder is made in the first place that lets one be made") {
  const TemporaryFolder place;
  const std::array bases{closed, fs::path(place.file("not/there")), fs::path(place.file("later"))};
  const LockedFolder folder(bases);
  CHECK(folder.path().parent_path() == bases[1]);
  CHECK(fs::is_directory(folder.path()));
}

TEST_CASE("where none can be made, the message names every place and what to do") {
  const std::array bases{closed, closed / "self"};
  try {
    const LockedFolder folder(bases);
    FAIL("a folder in /proc");
  } catch (const InternalError& error) {
    const std::string text = error.what();
    CHECK(text.find("/proc (") != std::string::npos);
    CHECK(text.find("/proc/self (") != std::string::npos);
    CHECK(text.find("by TMPDIR") != std::string::npos);
  }
}

TEST_CASE("folders go with their process, those of killed processes with the next one") {
  const TemporaryFolder place;
  const fs::path base = place.file("base");
  fs::create_directory(base);
  CHECK_FALSE(fs::exists(made_in(base)));
  const fs::path old = left_over(base);
  REQUIRE(fs::is_directory(old));
  const fs::path foreign = old.string() + "x", link = old.string() + "y", other = base / "kacanov-mpi-abcdef";
  for (const fs::path& folder : {foreign, other}) fs::create_directory(folder);
  fs::create_directory_symlink(other, link);
  const bool root = geteuid() == 0 && chown(foreign.c_str(), 12345, 12345) == 0;

  const std::array bases{base};
  const LockedFolder live(bases);
  CHECK_FALSE(fs::exists(old));
  CHECK(fs::exists(foreign) == root);  // owned by another user
  CHECK(fs::exists(link));
  CHECK(fs::exists(other));  // no evidence that its process has ended
  const fs::path second = made_in(base);
  CHECK(second != live.path());
  CHECK(fs::is_directory(live.path()));
}

TEST_CASE("a folder whose lock a child has inherited stays until that ends as well") {
  const TemporaryFolder place;
  const std::array bases{fs::path(place.file("base"))};
  int channel[2];
  REQUIRE(pipe(channel) == 0);
  const pid_t launcher = fork();
  if (launcher == 0) {
    const auto* folder = new LockedFolder(bases);
    if (fork() == 0) {  // as mpiexec does, which ends a little later
      char byte = 0;
      close(channel[1]);
      [[maybe_unused]] const ssize_t size = read(channel[0], &byte, 1);
      _exit(folder->handle() < 0 ? 1 : 0);
    }
    _exit(0);
  }
  waitpid(launcher, nullptr, 0);
  const fs::path left = fs::directory_iterator(bases[0])->path();
  CHECK_FALSE(fs::exists(made_in(bases[0])));
  CHECK(fs::is_directory(left));
  close(channel[0]);
  close(channel[1]);
  for (int tries = 0; fs::exists(left) && tries < 1000; ++tries) {
    usleep(10'000);
    made_in(bases[0]);
  }
  CHECK_FALSE(fs::exists(left));
}

TEST_CASE("the program finds its own file without /proc") {
  CHECK(fs::equivalent(own_executable("/not/there"), own_executable()));
}
