// SPDX-License-Identifier: BSD-3-Clause
// What breaks a run of the real program from outside: a rank that is killed, no memory, a full disk. One message, no hang, exit code 3.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <string>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// Where a run hangs, the test ends it and sees another exit code.
const std::string patience = "timeout -s KILL 120";

/// Starts a program of several ranks, kills the last of them once the file is there, and leaves with the program's exit code: kill_rank.sh FILE
/// PROGRAM ARGUMENTS...
constexpr const char* kill_script = R"(file=$1; shift
"$@" & program=$!
while [ ! -e "$file" ] && kill -0 $program 2>/dev/null; do sleep 0.02; done
for child in $(cat /proc/$program/task/*/children); do launcher=$child; done
for child in $(cat /proc/$launcher/task/*/children); do rank=$child; done
kill -s KILL $rank
wait $program
)";

/// Starts a program with a limit: limited.sh "-v KILOBYTES" PROGRAM ARGUMENTS... A file that grows too large is then an error like a full disk.
constexpr const char* limit_script = "trap '' XFSZ\nulimit $1\nshift\nexec \"$@\"\n";

/// Exit code 3 and one line with this text; result.json, where it is due, has it too.
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

/// Needs some 250 MB more than the program does for nothing; no contact, so that a step is a solve.
[[maybe_unused]] nlohmann::json large_block() {
  return nlohmann::json::parse(R"({
    "mesh": {"box": {"size": [2, 1, 1], "cells": [100, 50, 50], "element": "hex8"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "traction": [0, 0, -0.001]}],
    "solver": {"tolerance": 1e-2}
  })");
}

/// Two ranks under mpiexec, of which the last one has a limit.
[[maybe_unused]] std::string last_rank_limited(const std::string& limit, const std::string& arguments) {
  return arguments + " : -n 1 sh limited.sh '" + limit + "' '" KACANOV_PROGRAM "' " + arguments;
}
const std::string two_ranks = patience + " " KACANOV_MPIEXEC " --quiet --oversubscribe -n 1";

}  // namespace

TEST_CASE("a rank that is killed ends the run, which can go on from its checkpoint") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("kill_rank.sh", kill_script);
  const Outcome outcome =
      place.run("run beam.json --output out --ranks 3 --set solver.contact=admm --set solver.r=1e-6 "
                "--set solver.max_contact=2 --set solver.max_outer=100000000",
                patience + " sh kill_rank.sh out/checkpoint.kacanov");
  check_failed(place, outcome, "a process was ended by signal 9");
  REQUIRE(place.has("out/checkpoint.kacanov"));
  CHECK(place.run("run beam.json --output out --ranks 2 --restart").exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"].get<int>() >= 1);
}

#if !defined(__SANITIZE_ADDRESS__)  // whose shadow memory knows no limit
TEST_CASE("where memory runs out the run says so, on one rank and when only the last of two has none") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put_json("block.json", large_block());
  place.put("limited.sh", limit_script);
  // What the program and MPI need for nothing depends on the machine: the least with which a small case is solved.
  const auto least = [&](int kilobytes, const auto& run) {
    while (kilobytes < 4 << 20 && run("-v " + std::to_string(kilobytes)).exit_code != 0) kilobytes += 16 << 10;
    return kilobytes;
  };
  const int one = least(160 << 10, [&](const std::string& limit) {
    return place.run("run beam.json --output small", patience + " sh limited.sh '" + limit + "'");
  });
  const Outcome alone = place.run("run block.json --output alone --ranks 1",
                                  patience + " sh limited.sh '-v " + std::to_string(one + (48 << 10)) + "'");
  CHECK(alone.exit_code == 3);
  CHECK(alone.error == "kacanov: internal failure: out of memory\n");

  const int two = least(one + (48 << 10), [&](const std::string& limit) {
    return place.run(last_rank_limited(limit, "run beam.json --output small"), two_ranks);
  });
  // Enough for the part, not for solving: the first rank is within the solver when the other one fails. It is past METIS, too, which takes the
  // SIGTERM from mpiexec for a failure of its own.
  const std::string limit = "-v " + std::to_string(two + (96 << 10));
  check_failed(place, place.run(last_rank_limited(limit, "run block.json --output out"), two_ranks), "out of memory");
}
#endif

TEST_CASE("a full disk: what was written stays whole, nothing half is left") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"]["box"]["cells"] = {64, 16};
  place.put_json("beam.json", beam);
  place.put("limited.sh", limit_script);
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=1").exit_code == 1);
  const std::string before = contents(place.path("out/checkpoint.kacanov"));
  // A limit on the size of files stands for the full disk: the fields are larger, result.json and the checkpoint smaller.
  const std::uintmax_t fields = std::filesystem::file_size(place.path("out/body.vtu"));
  REQUIRE(before.size() < fields / 2);
  const std::string limit = "sh limited.sh '-f " + std::to_string(fields / 2 / 512) + "'";
  const Outcome outcome = place.run("run beam.json --output out --restart --set solver.max_outer=1", patience + " " + limit);
  check_failed(place, outcome, "out/body.vtu: cannot be written: File too large");
  CHECK_FALSE(place.has("out/body.vtu"));
  for (const auto& entry : std::filesystem::directory_iterator(place.path("out")))
    CHECK(entry.path().string().find(".part") == std::string::npos);
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"] == 2);

  const Outcome split = place.run("partition beam.json --ranks 2 --output parts", "sh limited.sh '-f 8'");
  CHECK(split.exit_code == 3);
  CHECK(split.error == "kacanov: internal failure: parts/part_1.kacanov: cannot be written: File too large\n");
  CHECK(std::filesystem::is_empty(place.path("parts")));
}
