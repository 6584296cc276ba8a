// SPDX-License-Identifier: BSD-3-Clause
// Bad input to the real program: exit code 2, one message, no files written.
#include <doctest/doctest.h>

#include <vector>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// Checks for exit code 2, nothing on standard output, one line that starts with `start`, and no results.
void check_refused(const Workplace& place, const Outcome& outcome, const std::string& start) {
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.output.empty());
  CHECK(count_lines(outcome.error) == 1);
  CHECK(outcome.error.rfind("kacanov: error: " + start, 0) == 0);
  CHECK_FALSE(place.has("results"));
}

nlohmann::json changed(const std::string& pointer, const nlohmann::json& value) {
  nlohmann::json document = small_beam();
  document[nlohmann::json::json_pointer(pointer)] = value;
  return document;
}

}  // namespace

TEST_CASE("parts that the mesh does not have are all named, with the file") {
  for (const char* words : {"run", "check", "run --ranks 2"}) {
    const Workplace place;
    nlohmann::json document = small_beam();
    document["boundary"][0]["on"] = "lfet";
    document["contact"][0]["on"] = "botom";
    place.put_json("beam.json", document);
    const Outcome outcome = place.run(std::string(words) + " beam.json");
    INFO(outcome.error);
    CHECK(outcome.exit_code == 2);
    CHECK(
        outcome.error.find("beam.json has 2 mistakes:\n  boundary[0].on: no part is called \"lfet\" (did you "
                           "mean \"left\"?)") != std::string::npos);
    CHECK(outcome.error.find("\n  contact[0].on: no part is called \"botom\" (did you mean \"bottom\"?)") !=
          std::string::npos);
    CHECK_FALSE(place.has("results"));
  }
}

TEST_CASE("bad cases are refused alike by run and check, alone and on two ranks") {
  struct Row {
    const char* pointer;
    nlohmann::json value;
    const char* start;
  };
  const std::vector<Row> rows{
      {"/solver", {{"tolerence", 1e-8}}, "solver.tolerence: unknown key (did you mean \"tolerance\"?)"},
      {"/material/0/young", -1, "material[0].young: expected a number > 0, got -1"},
      {"/boundary/0/on", "lfet",
       "boundary[0].on: no part is called \"lfet\" (did you mean \"left\"?); there are: all, bottom"},
      {"/boundary/1/on/box",
       {{9, 9}, {10, 10}},
       "boundary[1].on: the box from (9, 9) to (10, 10) holds no boundary facet"},
      {"/boundary/0/displacement", {nullptr, 0}, "boundary: nothing holds the body against"},
      {"/probe/0", {40, 1}, "probe[0]: the point (40, 1) lies outside the body"},
      {"/contact/0/friction",
       {{"tresca", "high"}},
       "contact[0].friction.tresca: expected a number ≥ 0, got \"high\""},
      {"/boundary/1/traction",
       {0, 1, 2},
       "boundary[1].traction: expected 2 entries, as the mesh has 2 dimensions, got 3"},
      {"/mesh", {{"file", "none.msh"}}, "none.msh"},
  };
  for (const Row& row : rows) {
    const Workplace place;
    nlohmann::json document = changed(row.pointer, row.value);
    // Friction would support the beam on rollers.
    if (std::string(row.pointer) == "/boundary/0/displacement") document["contact"][0].erase("friction");
    place.put_json("beam.json", document);
    check_refused(place, place.run("run beam.json"), row.start);
    check_refused(place, place.run("check beam.json"), row.start);
    check_refused(place, place.run("run beam.json --ranks 2"), row.start);
  }
}

TEST_CASE("corrupt meshes are refused with their file") {
  const Workplace place;
  place.put_json("beam.json", changed("/mesh", {{"file", "bad.msh"}}));
  for (const char* text : {"", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n",
                           "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4", "rubbish"}) {
    place.put("bad.msh", text);
    check_refused(place, place.run("run beam.json"), "bad.msh");
  }
}

TEST_CASE("case files that cannot be read") {
  const Workplace place;
  check_refused(place, place.run("run none.json"), "none.json: there is no such file");
  place.put("broken.json", "{\"mesh\": }");
  check_refused(place, place.run("run broken.json"), "broken.json:1:10: not valid JSON");
  check_refused(place, place.run("check broken.json"), "broken.json:1:10: not valid JSON");
}

TEST_CASE("an output folder that cannot be written is refused before solving") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("file", "a file");
  for (const char* ranks : {"", " --ranks 2"}) {
    check_refused(place, place.run("run beam.json --output file/inside" + std::string(ranks)),
                  "--output: the folder file/inside cannot be made");
  }
  check_refused(place, place.run("run beam.json --output file"), "--output: the folder file cannot be made");
  CHECK(contents(place.path("file")) == "a file");
}

TEST_CASE("mistakes on the command line") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const char* arguments :
       {"", "run", "fly beam.json", "run beam.json --rank 2", "run beam.json --ranks 0",
        "run beam.json --ranks two", "run beam.json other.json", "spectrum beam.json --tolerance 7",
        "sweep beam.json --r-min -1", "sweep beam.json --r-min 2 --r-max 1", "sweep beam.json --points 1"}) {
    const Outcome outcome = place.run(arguments);
    INFO("arguments: ", arguments, "\nerror: ", outcome.error);
    check_refused(place, outcome, "");
  }
  check_refused(place, place.run("run beam.json --set solver.tolerence=1"), "solver.tolerence: unknown key");
  check_refused(place, place.run("chekc beam.json"),
                "there is no command \"chekc\" (did you mean \"check\"?)");
  check_refused(place, place.run("run beam.json --set solver"), "--set: expected key=value");
}

TEST_CASE("spectrum and sweep need contact") {
  const Workplace place;
  nlohmann::json document = small_beam();
  document.erase("contact");
  place.put_json("beam.json", document);
  check_refused(place, place.run("spectrum beam.json"), "contact: the spectrum is that of the contact nodes");
  check_refused(place, place.run("sweep beam.json"), "contact: a sweep over r needs contact");
}

TEST_CASE("what is quoted from the command line is printed without what a terminal would obey") {
  const Workplace place;
  for (const std::string& words :
       {std::string("run c.json '--\x1b[31mopt'"), std::string("'\x1b]0;owned\x07'"),
        std::string("run '\xe2\x80\xaegnp.json'"), std::string("check '\xff.json'")}) {
    const Outcome outcome = place.run(words);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find('\x1b') == std::string::npos);
    CHECK(outcome.error.find('\x07') == std::string::npos);
    CHECK(outcome.error.find("\xe2\x80\xae") == std::string::npos);
    CHECK(outcome.error.find('\xff') == std::string::npos);
    CHECK(outcome.error.find("\\x") != std::string::npos);
  }
}
