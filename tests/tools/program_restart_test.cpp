// SPDX-License-Identifier: BSD-3-Clause
// Interrupted runs of the real program: the files they leave, and restarts from them.
#include <doctest/doctest.h>

#include <cmath>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// interrupt.sh SIGNAL FILE PROGRAM ARGUMENTS... starts a program, sends it a signal once the file exists,
/// and exits with the program's exit code.
constexpr const char* interrupt_script = R"(signal=$1; file=$2; shift 2
"$@" & program=$!
while [ ! -e "$file" ] && kill -0 $program 2>/dev/null; do sleep 0.02; done
kill -s $signal $program
wait $program
)";

/// With this penalty ADMM takes hours.
const std::string stubborn =
    " --set solver.contact=admm --set solver.r=1e-6 --set solver.max_contact=2 --set "
    "solver.max_outer=100000000";

void check_equal(const nlohmann::json& a, const nlohmann::json& b) {
  for (const std::size_t i : {0, 1})
    for (const std::size_t c : {0, 1})
      CHECK(a["probe"][i][c].get<double>() == doctest::Approx(b["probe"][i][c].get<double>()).epsilon(1e-5));
  CHECK(a["contact_force"][1].get<double>() ==
        doctest::Approx(b["contact_force"][1].get<double>()).epsilon(1e-5));
}

}  // namespace

TEST_CASE(
    "a signal ends a run with exit code 1, and --restart goes on to the same answer, on other ranks too") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["solver"] = {{"tolerance", 1e-7}};
  place.put_json("beam.json", beam);
  place.put("interrupt.sh", interrupt_script);
  REQUIRE(place.run("run beam.json --output whole").exit_code == 0);
  CHECK_FALSE(place.has("whole/checkpoint.kacanov"));  // nothing to continue
  const nlohmann::json whole = place.json("whole/result.json");
  struct Way {
    const char *signal, *first, *second;
  };
  for (const Way& way :
       {Way{"TERM", "--ranks 1", "--ranks 2"}, Way{"HUP", "--ranks 2", "--ranks 1 --threads 2"}}) {
    INFO(way.signal, " ", way.first, " ", way.second);
    const Outcome outcome =
        place.run("run beam.json --output out " + std::string(way.first) + stubborn,
                  "sh interrupt.sh " + std::string(way.signal) + " out/checkpoint.kacanov");
    INFO("error: ", outcome.error);
    REQUIRE(outcome.exit_code == 1);
    CHECK(outcome.error.empty());
    CHECK(outcome.output.find("\nINTERRUPTED: ") != std::string::npos);
    CHECK(outcome.output.find("out/checkpoint.kacanov; the option --restart goes on from there") !=
          std::string::npos);
    REQUIRE(place.has("out/checkpoint.kacanov"));
    const nlohmann::json stopped = place.json("out/result.json");
    CHECK(stopped["status"] == "interrupted");
    CHECK(stopped["outer_iterations"].get<int>() >= 1);
    CHECK(place.has("out/body.vtu"));

    const Outcome rest = place.run("run beam.json --output out --restart " + std::string(way.second));
    INFO("error: ", rest.error);
    CHECK(rest.exit_code == 0);
    const nlohmann::json result = place.json("out/result.json");
    CHECK(result["status"] == "converged");
    CHECK(result["restarted_after"] == stopped["outer_iterations"]);
    CHECK(result["outer_iterations"] > stopped["outer_iterations"]);
    CHECK(result["operator_applications"] > stopped["operator_applications"]);
    check_equal(result, whole);
    CHECK_FALSE(place.has("out/checkpoint.kacanov"));
  }
}

TEST_CASE("a run that has used up its steps goes on with more of them") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output whole").exit_code == 0);
  CHECK(place.run("run beam.json --output out --set solver.max_outer=3").exit_code == 1);
  REQUIRE(place.has("out/checkpoint.kacanov"));
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
  check_equal(place.json("out/result.json"), place.json("whole/result.json"));
}

TEST_CASE("load steps: the same answer, their history, and a restart among them") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output whole --set solver.tolerance=1e-7").exit_code == 0);
  CHECK_FALSE(place.json("whole/result.json").contains("load_steps"));
  const std::string steps =
      "run beam.json --output out --set solver.tolerance=1e-7 --set solver.load_steps=3";
  CHECK(place.run(steps + " --set solver.max_outer=2").exit_code == 1);
  const Outcome other = place.run(steps + " --set solver.load_steps=2 --restart");
  CHECK(other.exit_code == 2);
  CHECK(other.error.find("solver.load_steps differs (factors [") != std::string::npos);
  CHECK(place.run(steps + " --restart").exit_code == 0);
  const nlohmann::json result = place.json("out/result.json");
  check_equal(result, place.json("whole/result.json"));
  REQUIRE(result["load_steps"].size() == 3);
  CHECK(result["load_steps"][2]["factor"] == 1.0);
  CHECK(result["load_steps"][2]["probe"] == result["probe"]);
  CHECK(result["load_steps"][0]["contact_force"][1] < result["load_steps"][1]["contact_force"][1]);
}

TEST_CASE("without checkpoints there is none, and --restart says which file it expected") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  CHECK(place.run("run beam.json --output out --set solver.max_outer=3 --set output.checkpoint=false")
            .exit_code == 1);
  CHECK_FALSE(place.has("out/checkpoint.kacanov"));
  for (const char* ranks : {"", " --ranks 2"}) {
    const Outcome outcome = place.run("run beam.json --output out --restart" + std::string(ranks));
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error ==
          "kacanov: error: --restart: there is no checkpoint to go on from, expected the file "
          "out/checkpoint.kacanov\n");
  }
  CHECK(place.json("out/result.json")["status"] == "not_converged");  // unchanged
}

TEST_CASE("a checkpoint of another case is refused with what differs; the same case in other words is not") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=3").exit_code == 1);
  const auto refusal = [&](const std::string& change) {
    const Outcome outcome = place.run("run beam.json --output out --restart --set " + change);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find("out/checkpoint.kacanov belongs to another case: ") != std::string::npos);
    return outcome.error.substr(outcome.error.find("case: ") + 6);
  };
  CHECK(refusal("material[0].young=2.0") == "material differs (material[0].young: 1.0 there, 2.0 here)\n");
  CHECK(refusal("contact[0].friction.tresca=0.02") ==
        "contact differs (contact[0].friction.tresca: 0.01 there, 0.02 here)\n");
  CHECK(refusal("mesh.box.cells[0]=20").find("mesh differs (mesh.box.cells[0]: 16 there, 20 here)") !=
        std::string::npos);
  CHECK(refusal("boundary[1].traction[1]=-0.04") ==
        "boundary differs (boundary[1].traction[1]: -0.05 there, -0.04 here)\n");
  const Outcome outcome = place.run(
      "run beam.json --output out --restart --set boundary[1].on='{\"box\":[[1.9,0.9],[4.1,1.1]]}' "
      "--set solver.tolerance=1e-7");
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 0);
}

TEST_CASE("a checkpoint that is cut short or damaged is refused") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=3").exit_code == 1);
  const std::string whole = contents(place.path("out/checkpoint.kacanov"));
  const auto refusal = [&](const std::string& bytes) {
    place.put("out/checkpoint.kacanov", bytes);
    const Outcome outcome = place.run("run beam.json --output out --restart");
    CHECK(outcome.exit_code == 2);
    CHECK(count_lines(outcome.error) == 1);
    return outcome.error;
  };
  const std::string front = "kacanov: error: out/checkpoint.kacanov: this ";
  CHECK(refusal("") == front + "is no checkpoint that this version of kacanov can read\n");
  CHECK(refusal("{}") == front + "is no checkpoint that this version of kacanov can read\n");
  for (const std::size_t size :
       {std::size_t{21}, std::size_t{25}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
    INFO(size);
    CHECK(refusal(whole.substr(0, size)) ==
          front + "checkpoint is cut short: " + std::to_string(size) + " bytes\n");
  }
  CHECK(refusal(whole + "x") == front + "checkpoint is damaged: its content does not match its hash\n");
  for (std::size_t at = 30; at < whole.size(); at += whole.size() / 20) {
    INFO(at);
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    CHECK(refusal(damaged).rfind(front, 0) == 0);
  }
  place.put("out/checkpoint.kacanov", whole);
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
}

TEST_CASE("where a checkpoint cannot be written the one before stays, with a warning, and the run goes on") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"]["box"]["cells"] = {64, 16};
  place.put_json("beam.json", beam);
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=3").exit_code == 1);
  const std::string before = contents(place.path("out/checkpoint.kacanov"));
  // A limit on file sizes simulates a full disk; the run leaves no other files of that size.
  const Outcome outcome = place.run(
      "run beam.json --output out --restart --set solver.max_outer=2 --set output.fields=none --set "
      "output.report=false",
      "ulimit -f 30;");
  INFO("error: ", outcome.error);
  CHECK(before.size() > 30 * 512);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.error ==
        "kacanov: warning: out/checkpoint.kacanov: cannot be written: File too large; the checkpoint before "
        "it stays\n");
  CHECK(contents(place.path("out/checkpoint.kacanov")) == before);
  CHECK(place.json("out/result.json")["outer_iterations"] == 5);
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
}
