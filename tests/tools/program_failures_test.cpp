// SPDX-License-Identifier: BSD-3-Clause
// External failures during a run of the real program: a killed rank, no memory, a full disk. Each gives one
// message and exit code 3, without hanging.
#include <doctest/doctest.h>

#include <string>

#include "../sanitized.hpp"
#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// kill_rank.sh FILE PROGRAM ARGUMENTS... starts a program of several ranks, kills the last rank once the
/// file exists, and exits with the program's exit code.
constexpr const char* kill_script = R"(file=$1; shift
"$@" & program=$!
while [ ! -e "$file" ] && kill -0 $program 2>/dev/null; do sleep 0.02; done
for child in $(cat /proc/$program/task/*/children); do launcher=$child; done
for child in $(cat /proc/$launcher/task/*/children); do rank=$child; done
kill -s KILL $rank
wait $program
)";

/// signal.sh FILE PROGRAM ARGUMENTS... starts a program, sends it SIGTERM once the file exists, and exits
/// with its exit code; the shell's own message about the signal is suppressed.
constexpr const char* signal_script = R"(file=$1; shift
"$@" & program=$!
exec 2>/dev/null
while [ ! -e "$file" ] && kill -0 $program; do sleep 0.02; done
kill -s TERM $program
wait $program
)";

/// limited.sh "-v KILOBYTES" PROGRAM ARGUMENTS... starts a program with a limit. With a limit on file sizes a
/// file that grows too large is an error like a full disk.
constexpr const char* limit_script = "ulimit $1\nshift\nexec \"$@\"\n";

/// Checks for exit code 3 and one line with this text, which result.json contains too if it must exist.
void check_failed(const Workplace& place, const Outcome& outcome, const std::string& text) {
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 3);
  CHECK(count_lines(outcome.error) == 1);
  CHECK(outcome.error.rfind("kacanov: internal failure: ", 0) == 0);
  CHECK(outcome.error.find(text) != std::string::npos);
  REQUIRE(place.has("out/result.json"));
  const nlohmann::json result = place.json("out/result.json");
  CHECK(result["status"] == "failed");
  CHECK(result["message"].get<std::string>().find(text) != std::string::npos);
}

/// Checks that no file under a temporary name is left.
void check_nothing_half(const Workplace& place) {
  for (const auto& entry : std::filesystem::directory_iterator(place.path("out")))
    CHECK(entry.path().string().find(".part") == std::string::npos);
}

/// Needs some 250 MB more than the idle program; without contact, so that a step is one solve.
[[maybe_unused]] nlohmann::json large_block() {
  return parsed(R"({
    "mesh": {"box": {"size": [2, 1, 1], "cells": [100, 50, 50], "element": "hex8"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "traction": [0, 0, -0.001]}],
    "solver": {"tolerance": 1e-2}
  })");
}

/// Two ranks under mpiexec, of which only the last has a limit.
std::string last_rank_limited(const std::string& limit, const std::string& arguments) {
  return arguments + " : -n 1 sh limited.sh '" + limit + "' '" KACANOV_PROGRAM "' " + arguments;
}
const std::string two_ranks = patience + " " KACANOV_MPIEXEC " --quiet --oversubscribe -n 1";

}  // namespace

TEST_CASE("a rank that is killed ends the run, which can go on from its checkpoint") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("kill_rank.sh", kill_script);
  const Outcome outcome = place.run(
      "run beam.json --output out --ranks 3 --set solver.contact=admm --set solver.r=1e-6 "
      "--set solver.max_contact=2 --set solver.max_outer=100000000",
      patience + " sh kill_rank.sh out/checkpoint.kacanov");
  check_failed(place, outcome, "a process was ended by signal 9");
  REQUIRE(place.has("out/checkpoint.kacanov"));
  CHECK(place.run("run beam.json --output out --ranks 2 --restart").exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"].get<int>() >= 1);
}

TEST_CASE("where TMPDIR cannot be written to a run takes another folder for Open MPI's files") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const char* ranks : {"1", "2"}) {
    const Outcome outcome =
        place.run("run beam.json --output out --ranks " + std::string(ranks), patience + " env TMPDIR=/proc");
    INFO("error: ", outcome.error);
    CHECK(outcome.exit_code == 0);
    CHECK(place.json("out/result.json")["status"] == "converged");
  }
}

TEST_CASE("where MPI cannot be started the exit code is 3, and result.json says why") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  std::filesystem::create_directory(place.path("bin"));
  place.put("bin/mpiexec", "#!/bin/sh\nexit 1\n");
  std::filesystem::permissions(place.path("bin/mpiexec"), std::filesystem::perms::owner_all);
  const auto check_told = [&](const std::string& ranks, const std::string& before, const std::string& text) {
    INFO(before, " ", ranks, " ranks");
    const Outcome outcome =
        place.run("run beam.json --output out --ranks " + ranks, patience + " env " + before);
    CHECK(outcome.exit_code == 3);
    CHECK(outcome.error.rfind("kacanov: internal failure: ", 0) == 0);
    CHECK(outcome.error.find(text) != std::string::npos);
    REQUIRE(place.has("out/result.json"));
    const nlohmann::json result = place.json("out/result.json");
    CHECK(result["status"] == "failed");
    CHECK(result["message"].get<std::string>().find(text) != std::string::npos);
    CHECK_FALSE(result.contains("probe"));  // of the previous run
  };
  // No folder can be made in /proc.
  const std::string closed = "OMPI_MCA_orte_tmpdir_base=/proc";
  for (const bool again : {false, true}) {
    check_told("1", closed, "none can be made in /proc (");
    check_told("2", closed, "none can be made in /proc (");
    check_told("2", "PATH=\"$PWD/bin:$PATH\"", "mpiexec failed with exit code 1");
    if (!again) CHECK(place.run("run beam.json --output out").exit_code == 0);
  }
}

#ifndef KACANOV_TESTS_SANITIZED  // the shadow memory of the sanitizers exceeds any limit
TEST_CASE("where memory runs out the run says so, on one rank and when only the last of two has none") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put_json("block.json", large_block());
  place.put("limited.sh", limit_script);
  // The base memory of the program and MPI depends on the machine: find the least with which a small case is
  // solved.
  const auto least = [&](int kilobytes, const auto& run) {
    while (kilobytes < 4 << 20 && run("-v " + std::to_string(kilobytes)).exit_code != 0)
      kilobytes += 16 << 10;
    return kilobytes;
  };
  const int one = least(160 << 10, [&](const std::string& limit) {
    return place.run("run beam.json --output small", patience + " sh limited.sh '" + limit + "'");
  });
  const Outcome alone = place.run("run block.json --output alone --ranks 1",
                                  patience + " sh limited.sh '-v " + std::to_string(one + (48 << 10)) + "'");
  CHECK(alone.exit_code == 3);
  CHECK(alone.error == "kacanov: internal failure: out of memory\n");

  // With a few hundred megabytes Open MPI starts or hangs: never try less than it needs here.
  const int two = least(300 << 10, [&](const std::string& limit) {
    return place.run(last_rank_limited(limit, "run beam.json --output small"), two_ranks);
  });
  // Enough for the part, not for solving: the first rank is inside the solver when the other one fails.
  const std::string limit = "-v " + std::to_string(two + (32 << 10));
  check_failed(place, place.run(last_rank_limited(limit, "run block.json --output out"), two_ranks),
               "out of memory");
}

TEST_CASE("a limit under which MPI would crash or hang is refused before it starts") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("limited.sh", limit_script);
  const Outcome outcome = place.run("run beam.json --ranks 2", patience + " sh limited.sh '-v 300000'");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error ==
        "kacanov: error: several ranks cannot be started: the address space of a process is limited to 292 "
        "MiB (ulimit -v), and MPI needs 512\n");
  CHECK_FALSE(place.has("results"));
}
#endif

TEST_CASE("a signal while METIS is at work ends the program, without a failure of METIS") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"]["box"]["cells"] = {320, 80};
  place.put_json("beam.json", beam);
  place.put("signal.sh", signal_script);
  // So many parts that METIS takes seconds; their folder is made just before.
  const Outcome outcome = place.run("partition beam.json --ranks 20000 --output parts",
                                    patience + " sh signal.sh parts/unfinished");
  CHECK(outcome.exit_code == 143);
  CHECK(outcome.error.empty());
  CHECK_FALSE(place.has("parts/boundary.kacanov"));
}

TEST_CASE("a full disk: what was written stays whole, nothing half is left") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"]["box"]["cells"] = {64, 16};
  place.put_json("beam.json", beam);
  place.put("limited.sh", limit_script);
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=1").exit_code == 1);
  const std::string before = contents(place.path("out/checkpoint.kacanov"));
  // A limit on file sizes simulates a full disk: the fields exceed it, result.json and the checkpoint do not.
  const std::uintmax_t fields = std::filesystem::file_size(place.path("out/body.vtu"));
  REQUIRE(before.size() < fields / 2);
  const std::string limit = "sh limited.sh '-f " + std::to_string(fields / 2 / 512) + "'";
  const Outcome outcome =
      place.run("run beam.json --output out --restart --set solver.max_outer=1", patience + " " + limit);
  check_failed(place, outcome, "out/body.vtu: cannot be written: File too large");
  CHECK_FALSE(place.has("out/body.vtu"));
  check_nothing_half(place);
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"] == 2);
}

TEST_CASE("a full disk on several ranks, of which the first one writes" * doctest::skip(sanitized)) {
  const Workplace place;
  nlohmann::json beam = small_beam();
  // A file larger than any that MPI itself writes: four megabytes of shared memory per rank.
  beam["mesh"]["box"]["cells"] = {400, 100};
  beam["material"][0].erase("law");
  beam["solver"] = {{"tolerance", 1e-3}, {"max_outer", 1}};
  place.put_json("beam.json", beam);
  place.put("limited.sh", limit_script);
  constexpr int most = 9 << 19;
  const std::string limit = "-f " + std::to_string(most / 512);
  const std::string run = "run beam.json --output out", restart = run + " --restart";
  REQUIRE(place.run(run + " --ranks 2").exit_code == 1);
  const std::string before = contents(place.path("out/checkpoint.kacanov"));
  REQUIRE(before.size() < most);
  REQUIRE(std::filesystem::file_size(place.path("out/body.vtu")) > most);

  check_failed(place, place.run(restart + " --ranks 2", patience + " sh limited.sh '" + limit + "'"),
               "out/body.vtu: cannot be written: File too large");
  check_nothing_half(place);
  CHECK_FALSE(place.has("out/body.vtu"));
  CHECK(place.run(last_rank_limited(limit, restart), two_ranks).exit_code == 1);
  CHECK(place.json("out/result.json")["status"] == "not_converged");
  CHECK(place.has("out/body.vtu"));
  CHECK(place.run(restart + " --ranks 3 --set solver.max_outer=100").exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"] == 3);
}

TEST_CASE("a full disk leaves the parts of the split before") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("limited.sh", limit_script);
  const auto check_full = [&] {
    const Outcome outcome = place.run("partition beam.json --ranks 2 --output parts", "sh limited.sh '-f 8'");
    CHECK(outcome.exit_code == 3);
    CHECK(outcome.error ==
          "kacanov: internal failure: parts/unfinished/part_1.kacanov: cannot be written: File too large\n");
  };
  check_full();
  CHECK(std::filesystem::is_empty(place.path("parts")));
  REQUIRE(place.run("partition beam.json --ranks 3 --output parts").exit_code == 0);
  check_full();
  CHECK(place.run("run beam.json --parts parts").exit_code == 0);
  CHECK(place.json("results/beam/result.json")["ranks"] == 3);
  // The remains of a killed partition do no harm, and the next one removes them.
  std::filesystem::create_directory(place.path("parts/unfinished"));
  place.put("parts/unfinished/part_7.kacanov", "half");
  REQUIRE(place.run("partition beam.json --ranks 2 --output parts").exit_code == 0);
  CHECK(std::distance(std::filesystem::directory_iterator(place.path("parts")), {}) == 3);
}
