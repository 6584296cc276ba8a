// SPDX-License-Identifier: BSD-3-Clause
// Files of runs are neither lost nor mixed: two runs in one folder, links and unusual names, cases from
// pipes, closed output pipes, paused runs.
#include <doctest/doctest.h>

#include <string>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// A run that continues until it is told to stop.
const std::string endless =
    "run beam.json --output out --set solver.contact=admm --set solver.r=1e-6 "
    "--set solver.max_contact=2 --set solver.max_outer=100000000";

/// Runs a script with sh; $PROGRAM is the program.
Outcome script(const Workplace& place, const std::string& text) {
  place.put("script.sh", "PROGRAM=$1\n" + text);
  return place.run("", patience + " sh script.sh");
}

/// Shell commands that wait until a file exists, for a minute at most.
std::string await(const std::string& file) {
  return "n=0; until [ -e " + file + " ] || [ $n = 600 ]; do sleep 0.1; n=$((n+1)); done\n";
}

}  // namespace

TEST_CASE("a folder serves one run at a time, and is free again however that ends") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const std::string ranks : {" --ranks 1", " --ranks 2"}) {
    INFO(ranks);
    const Outcome second = script(place, "$PROGRAM " + endless + ranks + " >/dev/null 2>&1 & first=$!\n" +
                                             await("out/checkpoint.kacanov") +
                                             "$PROGRAM run beam.json --output out; code=$?\n"
                                             "kill -KILL $first; wait $first 2>/dev/null\nexit $code\n");
    CHECK(second.exit_code == 2);
    CHECK(second.error.find("--output: another run (process ") != std::string::npos);
    CHECK(count_lines(second.error) == 1);
    // The ranks of the killed run need a moment to notice.
    const Outcome third = script(place,
                                 "n=0; until $PROGRAM run beam.json --output out --restart >/dev/null || "
                                 "[ $n = 50 ]; do sleep 0.2; n=$((n+1)); done\n[ $n -lt 50 ]\n");
    CHECK(third.exit_code == 0);
    CHECK(place.json("out/result.json")["status"] == "converged");
    CHECK_FALSE(place.has("out/.lock"));
  }
}

TEST_CASE("nothing is written through a link that lies in wait") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("precious", "kept");
  std::filesystem::create_directory(place.path("out"));
  std::filesystem::create_symlink(place.path("precious"), place.path("out/.lock"));
  CHECK(place.run("run beam.json --output out").exit_code == 2);
  CHECK(contents(place.path("precious")) == "kept");
  std::filesystem::remove(place.path("out/.lock"));
  std::filesystem::create_symlink(place.path("precious"), place.path("out/result.json"));
  CHECK(place.run("run beam.json --output out").exit_code == 0);
  CHECK(contents(place.path("precious")) == "kept");
}

TEST_CASE("a partition takes away nothing but its own files") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  std::filesystem::create_directories(place.path("parts/unfinished"));
  place.put("parts/unfinished/thesis.txt", "years");
  const Outcome outcome = place.run("partition beam.json --ranks 2 --output parts");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error.find("parts/unfinished/thesis.txt") != std::string::npos);
  CHECK(contents(place.path("parts/unfinished/thesis.txt")) == "years");
}

TEST_CASE("a case whose name is a way up writes below results") {
  const Workplace place;
  place.put_json("...json", small_beam());
  CHECK(place.run("run ...json").exit_code == 0);
  CHECK(place.has("results/case/result.json"));
}

TEST_CASE("a case may come through a pipe, on several ranks too, and is read once") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const std::string ranks : {"1", "2"}) {
    INFO(ranks);
    const Outcome outcome =
        script(place, "mkfifo pipe" + ranks + "\ncat beam.json > pipe" + ranks + " &\n$PROGRAM run pipe" +
                          ranks + " --output out --ranks " + ranks + "\n");
    CHECK(outcome.exit_code == 0);
    CHECK(place.json("out/result.json")["ranks"].get<int>() == std::stoi(ranks));
  }
}

TEST_CASE("a pipe where a file belongs is refused and not waited for") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const auto refused = [&](const std::string& pipe, const std::string& arguments) {
    INFO(pipe);
    const Outcome outcome = script(
        place, "rm -f " + pipe + "; mkfifo " + pipe + "; timeout -s KILL 20 $PROGRAM " + arguments + "\n");
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find(pipe) != std::string::npos);
    CHECK(outcome.error.find("regular") != std::string::npos);
  };
  REQUIRE(place.run("partition beam.json --ranks 1 --output parts").exit_code == 0);
  REQUIRE(place.run("run beam.json --output out").exit_code == 0);
  refused("out/body.vtu", "verify beam.json --output out");
  refused("out/result.json", "verify beam.json --output out");
  refused("out/checkpoint.kacanov", "run beam.json --output out --restart");
  refused("parts/part_0.kacanov", "run beam.json --parts parts");
  refused("parts/boundary.kacanov", "run beam.json --parts parts");
}

TEST_CASE("too much of a case is refused by its limits") {
  const Workplace place;
  place.put("deep.json", std::string(300000, '['));
  Outcome outcome = place.run("run deep.json");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error.find("more than 64 levels of brackets") != std::string::npos);
  outcome =
      script(place, "head -c 100000000 /dev/zero | tr '\\0' ' ' > large.json; $PROGRAM run large.json\n");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error.find("large.json: this is larger than 64 MiB") != std::string::npos);
  place.put_json("beam.json", small_beam());
  outcome = place.run("check beam.json --set solver.load_steps=2000000000");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error.find("solver.load_steps: expected at most 10000 load steps") != std::string::npos);
}

TEST_CASE("what a name has of a terminal's language does not get there") {
  const Workplace place;
  const std::string name = "red\033[31m";
  place.put_json(name + ".json", small_beam());
  const Outcome outcome = place.run("run '" + name + ".json'");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output.find('\033') == std::string::npos);
  CHECK(outcome.output.find("red\\x1b[31m") != std::string::npos);
  CHECK(place.has("results/" + name + "/result.json"));
}

TEST_CASE("numbers come first, and no picture takes them away") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  // A folder in the place of the picture, which makes it impossible to write.
  std::filesystem::create_directories(place.path("out/deformed.svg/in the way"));
  Outcome outcome = place.run("run beam.json --output out");
  CHECK(outcome.exit_code == 2);  // removing an old picture must not remove anything else
  CHECK(place.has("out/deformed.svg/in the way"));
  std::filesystem::remove_all(place.path("out"));
  // Fields that exceed the limit: the run has failed, but its numbers exist.
  place.put("limited.sh", "ulimit -f $1\nshift\nexec \"$@\"\n");
  outcome = place.run("run beam.json --output out --set mesh.box.cells=[64,16] --set output.checkpoint=false",
                      patience + " sh limited.sh 40");
  CHECK(outcome.exit_code == 3);
  CHECK(place.json("out/result.json")["status"] == "failed");
  CHECK(place.json("out/result.json")["probe"].size() == 2);
}

TEST_CASE("a run whose words nobody reads writes all its files and leaves with its own code") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const std::string ranks : {" --ranks 1", " --ranks 2"})
    for (const std::string sink : {" >/dev/full", " | true", " >&-"}) {
      INFO(ranks, sink);
      std::filesystem::remove_all(place.path("out"));
      CHECK(
          script(place, "{ $PROGRAM run beam.json --output out" + ranks + "; echo $? > code; }" + sink + "\n")
              .exit_code == 0);
      CHECK(contents(place.path("code")) == "0\n");
      CHECK(place.json("out/result.json")["status"] == "converged");
      CHECK(place.has("out/summary.txt"));
    }
  // If printing is the only task, failing to print is an error.
  CHECK(place.run("check beam.json", "sh -c '\"$0\" \"$@\" >/dev/full'").exit_code == 3);
}

TEST_CASE("a run of several ranks pauses and goes on with its terminal") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  // Stopped ranks write no checkpoints; resumed ranks do.
  const Outcome outcome = script(place, "$PROGRAM " + endless + " --ranks 2 >/dev/null 2>&1 & run=$!\n" +
                                            await("out/checkpoint.kacanov") +
                                            "kill -TSTP $run; sleep 0.5\nrm out/checkpoint.kacanov; sleep 1\n"
                                            "[ ! -e out/checkpoint.kacanov ] || echo went on\n"
                                            "kill -CONT $run\n" +
                                            await("out/checkpoint.kacanov") +
                                            "[ -e out/checkpoint.kacanov ] || echo stopped for good\n"
                                            "kill -TERM $run; wait $run\n");
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.empty());
  CHECK(place.json("out/result.json")["status"] == "interrupted");
}

TEST_CASE("a folder under the name of a result is no result, and stays") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const char* name : {"summary.txt", "deformed.svg", "report.html"}) {
    std::filesystem::create_directories(place.path(std::string("out/") + name));
    const Outcome outcome = place.run("run beam.json --output out");
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error == std::string("kacanov: error: --output: out/") + name +
                               " stands where a file of the run belongs, and is a folder: move it away\n");
    CHECK(place.has(std::string("out/") + name));
    std::filesystem::remove(place.path(std::string("out/") + name));
  }
}

TEST_CASE("each run keeps Open MPI's files in a folder of its own, and leaves none behind") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  std::filesystem::create_directory(place.path("tmp"));
  for (const char* ranks : {"1", "2"}) {
    // The folder while the ranks work: one session each.
    const Outcome outcome =
        script(place, std::string("export TMPDIR=$PWD/tmp\n$PROGRAM ") + endless + " --ranks " + ranks +
                          " >/dev/null 2>&1 & run=$!\n" + await("out/checkpoint.kacanov") +
                          "ls tmp\nls tmp/kacanov-mpi-*\nkill -TERM $run\nwait $run\nrm -r out\n");
    CHECK(outcome.output.find("kacanov-mpi-") == 0);
    CHECK(outcome.output.find("ompi.") != std::string::npos);
    CHECK(std::filesystem::is_empty(place.path("tmp")));
  }
  // A folder set by the user is used.
  std::filesystem::create_directory(place.path("mine"));
  const Outcome told =
      script(place, "export TMPDIR=$PWD/tmp OMPI_MCA_orte_tmpdir_base=$PWD/mine\n$PROGRAM " + endless +
                        " >/dev/null 2>&1 & run=$!\n" + await("out/checkpoint.kacanov") +
                        "ls tmp mine\nkill -TERM $run\nwait $run\n");
  CHECK(told.output.find("kacanov-mpi-") == std::string::npos);
  CHECK(told.output.find("ompi.") != std::string::npos);
}
