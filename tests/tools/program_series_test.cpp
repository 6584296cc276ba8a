// SPDX-License-Identifier: BSD-3-Clause
// Fields of every load step, and the series of them that ParaView plays.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// Returns the attributes of each start tag with this name, one string per tag.
std::vector<std::string> tags(const std::string& xml, const std::string& name) {
  std::vector<std::string> found;
  for (std::size_t at = xml.find("<" + name + " "); at != std::string::npos;
       at = xml.find("<" + name + " ", at + 1))
    found.push_back(xml.substr(at, xml.find('>', at) - at));
  return found;
}

std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t from = tag.find(" " + name + "=\"") + name.size() + 3;
  return tag.substr(from, tag.find('"', from) - from);
}

/// Returns the times of the series after checking that each file exists and has one piece.
std::vector<double> times(const Workplace& place, const std::string& folder) {
  std::vector<double> found;
  for (const std::string& set : tags(contents(place.path(folder + "/result.pvd")), "DataSet")) {
    const double time = std::stod(attribute(set, "timestep"));
    if (attribute(set, "part") == "0") found.push_back(time);
    const std::string file = folder + "/" + attribute(set, "file");
    REQUIRE(place.has(file));
    CHECK(tags(contents(place.path(file)), "Piece").size() == 1);
  }
  return found;
}

}  // namespace

TEST_CASE("every load step leaves its fields, and the series has their times") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["steps"] = parsed(R"([{"time": 0.5, "factors": {"boundary[1]": 0.5}},
                             {"time": 2, "factors": {"boundary[1]": 1}},
                             {"time": 3, "factors": {"boundary[1]": 0.25}}])");
  place.put_json("beam.json", beam);
  for (const char* ranks : {"", " --ranks 2", " --ranks 3"}) {
    REQUIRE(place.run("run beam.json --output out" + std::string(ranks)).exit_code == 0);
    CHECK(times(place, "out") == std::vector<double>{0.5, 2, 3});
  }
  CHECK(place.has("out/body_step_1.vtu"));
  REQUIRE(place.run("run beam.json --output out --set output.steps=false").exit_code == 0);
  CHECK(times(place, "out") == std::vector<double>{3});
  CHECK_FALSE(place.has("out/body_step_1.vtu"));
  CHECK(place.run("run beam.json --output out --set output.steps=3").exit_code == 2);
}

TEST_CASE("the fields of a load step are those of a run that ends with it") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["solver"]["load_steps"] = parsed("[0.5, 1]");
  place.put_json("steps.json", beam);
  REQUIRE(place.run("run steps.json --output steps").exit_code == 0);
  beam["solver"].erase("load_steps");
  beam["steps"] = parsed(R"([{"time": 0.5, "factors": {"boundary[1]": 0.5}}])");
  place.put_json("half.json", beam);
  REQUIRE(place.run("run half.json --output half").exit_code == 0);
  // Both reach it by the same steps.
  CHECK(contents(place.path("steps/body_step_1.vtu")) == contents(place.path("half/body.vtu")));
  CHECK(contents(place.path("steps/contact_step_1.vtu")) == contents(place.path("half/contact.vtu")));
}

TEST_CASE("a run that goes on keeps the fields of the load steps behind it") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const std::string run = "run beam.json --output out --set solver.load_steps=[0.001,1]";
  int most = 1, code = 1;
  for (; most < 20 && code == 1 && !place.has("out/body_step_1.vtu"); ++most)
    code = place.run(run + " --set solver.max_outer=" + std::to_string(most)).exit_code;
  REQUIRE(code == 1);
  REQUIRE(place.has("out/body_step_1.vtu"));
  REQUIRE(place.run(run + " --restart").exit_code == 0);
  CHECK(times(place, "out") == std::vector<double>{0.001, 1});
}

TEST_CASE("an obstacle that moves leaves a series too; factors are no times") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["contact"][0]["relinearise"] = true;
  beam["solver"]["load_steps"] = 2;
  place.put_json("beam.json", beam);
  REQUIRE(place.run("run beam.json --output out").exit_code == 0);
  CHECK(times(place, "out") == std::vector<double>{0.5, 1});
  const nlohmann::json steps = place.json("out/result.json").at("load_steps");
  CHECK(steps.at(0).at("factor") == 0.5);
  CHECK_FALSE(steps.at(0).contains("time"));
}
