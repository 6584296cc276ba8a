// SPDX-License-Identifier: BSD-3-Clause
// Signals to a run: it stops in order whatever threads a library has started, and --stop-within enforces a
// stop.
#include <doctest/doctest.h>

#include <chrono>
#include <string>

#include "../sanitized.hpp"
#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// A run that continues until it is told to stop, with a checkpoint after every step.
const std::string endless =
    "run beam.json --output out --set solver.contact=admm --set solver.r=1e-6 "
    "--set solver.max_contact=2 "
    "--set solver.max_outer=100000000 --ranks ";
const std::string endless_ranks = endless + "2";

/// Starts a program of several ranks as $program, and finds them as $ranks once there is a checkpoint.
const std::string start_ranks = R"("$@" & program=$!
exec 2>/dev/null
while [ ! -e out/checkpoint.kacanov ] && kill -0 $program; do sleep 0.02; done
for child in $(cat /proc/$program/task/*/children); do launcher=$child; done
ranks=$(cat /proc/$launcher/task/*/children)
for rank in $ranks; do last=$rank; done
)";

/// early.sh SIGNAL FILE PROGRAM ARGUMENTS... starts a program with a thread older than its main(), sends it a
/// signal once the file exists, and exits with its exit code.
constexpr const char* early_script = R"(signal=$1; file=$2; shift 2
LD_PRELOAD=')" KACANOV_EARLY_THREAD R"(' "$@" & program=$!
exec 2>/dev/null
while [ ! -e "$file" ] && kill -0 $program; do sleep 0.02; done
kill -s $signal $program
wait $program
)";

}  // namespace

// The preloaded library cannot be combined with the sanitizers.
TEST_CASE("a signal that a thread from before main() receives stops a run in order" *
          doctest::skip(sanitized)) {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("early.sh", early_script);
  for (const char* signal : {"TERM", "HUP"})
    for (const char* ranks : {"1", "2"}) {
      INFO(signal, " ", ranks, " ranks");
      const Outcome outcome = place.run(
          endless + ranks, patience + " sh early.sh " + std::string(signal) + " out/checkpoint.kacanov");
      CHECK(outcome.exit_code == 1);
      CHECK(place.json("out/result.json")["status"] == "interrupted");
      CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
    }
}

TEST_CASE("a signal that a thread from before main() receives ends METIS' work" * doctest::skip(sanitized)) {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"]["box"]["cells"] = {320, 80};
  place.put_json("beam.json", beam);
  place.put("early.sh", early_script);
  const Outcome outcome = place.run("partition beam.json --ranks 20000 --output parts",
                                    patience + " sh early.sh TERM parts/unfinished");
  CHECK(outcome.exit_code == 143);
  CHECK_FALSE(place.has("parts/boundary.kacanov"));
}

TEST_CASE("a run that does not stop when asked to is ended after some seconds, by itself") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  // The last rank hangs: the first one cannot reach the point where it would stop.
  place.put("hang.sh", start_ranks + "kill -s STOP $last\nkill -s TERM $program\nwait $program\n");
  const auto before = std::chrono::steady_clock::now();
  const Outcome outcome = place.run(endless_ranks + " --stop-within 1", patience + " sh hang.sh");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 128 + 15);
  CHECK(seconds < 30.0);
  for (const auto& entry : std::filesystem::directory_iterator(place.path("out")))
    CHECK(entry.path().string().find(".part") == std::string::npos);
  CHECK_FALSE(place.has("out/result.json"));
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"].get<int>() >= 1);
}

TEST_CASE("a run that stops in time is not ended, however soon that had to be") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("stop.sh", start_ranks + "kill -s TERM $program\nwait $program\n");
  CHECK(place.run(endless_ranks + " --stop-within 20", patience + " sh stop.sh").exit_code == 1);
  CHECK(place.json("out/result.json")["status"] == "interrupted");
}
