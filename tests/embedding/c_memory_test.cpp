// SPDX-License-Identifier: BSD-3-Clause
// The C interface when memory runs out: it returns a code, and neither it nor METIS prints anything.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <new>

#include <kacanov/locality.hpp>
#include "c_example.hpp"

namespace {

struct End {
  int code = -1;
  std::string printed;
};

/// Runs `work` in a child process whose address space may grow by at most `room` bytes; returns its code and
/// output.
End do_within(rlim_t room, const std::function<int()>& work) {
  int channel[2];
  REQUIRE(pipe(channel) == 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(channel[1], STDOUT_FILENO);
    dup2(channel[1], STDERR_FILENO);
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    const rlim_t limit = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + room;
    const rlimit narrow{limit, limit};
    setrlimit(RLIMIT_AS, &narrow);
    _exit(work());
  }
  close(channel[1]);
  End end;
  char piece[256];
  for (ssize_t size = 0; (size = read(channel[0], piece, sizeof piece)) > 0;)
    end.printed.append(piece, static_cast<std::size_t>(size));
  close(channel[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
  return end;
}

/// Repeats the work with growing memory limits until it succeeds.
void check_silence(const std::function<int()>& work) {
  bool lacked = false, made = false;
  for (rlim_t room = 1 << 16; !made && room < rlim_t{1} << 30; room += std::max<rlim_t>(1 << 16, room / 24)) {
    const End end = do_within(room, work);
    INFO("room ", room, ", code ", end.code);
    CHECK((end.code == KACANOV_OK || end.code == KACANOV_ERROR_MEMORY));
    CHECK(end.printed == "");
    lacked = lacked || end.code == KACANOV_ERROR_MEMORY;
    made = end.code == KACANOV_OK;
  }
  CHECK(lacked);
  CHECK(made);
}

}  // namespace

TEST_CASE("wherever memory ends, the code says so and nothing is printed") {
  const Example example(KACANOV_TET4, 16);
  check_silence([&] {
    kacanov_operator* op = nullptr;
    return kacanov_create(&example.description, &op, nullptr, 0);
  });
}

TEST_CASE("METIS is not asked for more than there is, and has no reason to print") {
  const SmallMesh mesh = small_mesh(KACANOV_TET4, 20);
  const kacanov::MeshView view{kacanov::ElementType::tet4, mesh.coordinates, mesh.connectivity};
  const std::vector<std::int32_t> order = kacanov::node_order(view);
  check_silence([&]() -> int {
    try {
      kacanov::partition_nodes(view, order, 400);
      return KACANOV_OK;
    } catch (const std::bad_alloc&) {
      return KACANOV_ERROR_MEMORY;
    }
  });
}
