// SPDX-License-Identifier: BSD-3-Clause
// Slip relative to the previous load step, with fixed, moving, force-controlled and relinearised obstacles,
// and errors that the verifier must find in such runs.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "verified_run.hpp"

using namespace kacanov::testing;

namespace {

/// Two blocks in 2D that do not touch, the second one at x = 5: groups "<name> bottom" and "<name> top".
std::string two_blocks() {
  std::ostringstream nodes, cells;
  int node = 0, cell = 0;
  const auto block = [&](int group, double left, int columns, int rows) {
    const int first = node + 1;
    const auto at = [&](int i, int j) { return first + j * (columns + 1) + i; };
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i)
        nodes << ++node << " " << left + 0.25 * i << " " << 0.25 * j << " 0\n";
    for (int i = 0; i < columns; ++i) {
      cells << ++cell << " 1 2 " << group << " 1 " << at(i, 0) << " " << at(i + 1, 0) << "\n";
      cells << ++cell << " 1 2 " << group + 1 << " 1 " << at(i, rows) << " " << at(i + 1, rows) << "\n";
    }
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        cells << ++cell << " 3 2 9 1 " << at(i, j) << " " << at(i + 1, j) << " " << at(i + 1, j + 1) << " "
              << at(i, j + 1) << "\n";
  };
  block(1, 0.0, 8, 4);
  block(3, 5.0, 4, 2);
  std::ostringstream text;
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"slab bottom\"\n1 2 \"slab top\"\n"
          "1 3 \"other bottom\"\n1 4 \"other top\"\n2 9 \"body\"\n$EndPhysicalNames\n$Nodes\n"
       << node << "\n"
       << nodes.str() << "$EndNodes\n$Elements\n"
       << cell << "\n"
       << cells.str() << "$EndElements\n";
  return text.str();
}

/// A slab that is pressed on a floor, dragged along and moved halfway back; the other block is fixed above a
/// plane.
nlohmann::json slab_and_block(const std::string& reference) {
  nlohmann::json input = parsed(R"({
    "mesh": {"file": "blocks.msh"},
    "material": [{"on": "all", "young": 1000, "poisson": 0.3}],
    "boundary": [{"on": "slab top", "name": "down", "displacement": [null, -0.005]},
                 {"on": "slab top", "name": "drag", "displacement": [0.02, null]},
                 {"on": "other top", "displacement": [0, 0]}],
    "contact": [{"on": "slab bottom", "name": "floor",
                 "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}, "friction": {"coulomb": 0.3}},
                {"on": "other bottom", "name": "other",
                 "obstacle": {"plane": {"point": [0, -0.01], "normal": [0, 1]}}}],
    "steps": [{"time": 1, "factors": {"down": 1, "drag": 0}}, {"time": 2, "factors": {"drag": 1}},
              {"time": 3, "factors": {"drag": 0.5}}],
    "output": {"report": false}})");
  input["contact"][0]["friction"]["reference"] = reference;
  return input;
}

double friction(const nlohmann::json& result, const char* name) {
  return result.at("contact").at(name).at("friction_force").at(0);
}

constexpr const char* lift = R"({"path": [{"time": 3, "translation": [0.004, 0.012]}]})";
constexpr const char* push = R"({"force": 3, "direction": [0.1, 1]})";

/// All combinations of relinearisation, motion and force control of a contact entry.
std::vector<nlohmann::json> movements() {
  std::vector<nlohmann::json> all;
  for (const char* one : {"{}", R"({"relinearise": true})"}) {
    all.push_back(parsed(one));
    all.push_back(parsed(one));
    all.back()["motion"] = parsed(lift);
    all.push_back(parsed(one));
    all.back()["force_controlled"] = parsed(push);
  }
  return all;
}

}  // namespace

TEST_CASE("a reference belongs to its entry, whatever moves beside it") {
  const Workplace place;
  place.put("blocks.msh", two_blocks());
  std::vector<double> alone;
  for (const char* reference : {"start", "step"}) {
    nlohmann::json input = slab_and_block(reference);
    alone.push_back(friction(solved(place, input), "floor"));
    int ranks = 1;
    for (const nlohmann::json& movement : movements())
      for (const char* other : {"", "start", "step"}) {
        input["contact"][1] = slab_and_block(reference)["contact"][1];
        input["contact"][1].update(movement);
        if (*other != '\0') input["contact"][1]["friction"] = {{"coulomb", 0.4}, {"reference", other}};
        INFO(input["contact"].dump());
        ranks = 3 - ranks;
        const nlohmann::json result = solved(place, input, std::to_string(ranks));
        CHECK(friction(result, "floor") == doctest::Approx(alone.back()).epsilon(1e-4));
      }
  }
  CHECK(std::abs(alone[0] - alone[1]) > 1.0);
}

TEST_CASE("an entry that moves, is pushed or is faced again has its own reference, too") {
  const Workplace place;
  place.put("blocks.msh", two_blocks());
  for (const nlohmann::json& movement : movements()) {
    std::vector<double> found;
    for (const char* reference : {"start", "step"})
      for (const char* other : {"start", "step"}) {
        nlohmann::json input = slab_and_block(reference);
        input["contact"][0].update(movement);
        input["contact"][1]["obstacle"]["plane"]["point"] = {0, 0.002};
        input["contact"][1]["friction"] = {{"tresca", 0.5}, {"reference", other}};
        INFO(input["contact"].dump());
        found.push_back(friction(solved(place, input), "floor"));
      }
    CHECK(found[1] == doctest::Approx(found[0]).epsilon(1e-4));
    CHECK(found[3] == doctest::Approx(found[2]).epsilon(1e-4));
    CHECK(std::abs(found[2] - found[0]) > 0.1);
  }
}

TEST_CASE("a floor that goes to and fro drags as the top that does so the other way") {
  const Workplace place;
  place.put("blocks.msh", two_blocks());
  nlohmann::json input = slab_and_block("step");
  const double dragged = friction(solved(place, input), "floor");
  input["contact"][0]["motion"] =
      parsed(R"({"path": [{"time": 1, "translation": [0, 0]}, {"time": 2, "translation": [-0.02, 0]},
                          {"time": 3, "translation": [-0.01, 0]}]})");
  input["boundary"][1]["displacement"][0] = 0;
  for (auto& step : input["steps"]) step["factors"].erase("drag");
  for (const bool again : {false, true}) {
    input["contact"][0]["relinearise"] = again;
    CHECK(friction(solved(place, input), "floor") == doctest::Approx(dragged).epsilon(1e-4));
  }
}

TEST_CASE("coarser meshes, adapted ones, cut steps and a restart count slip as without") {
  const Workplace place;
  nlohmann::json input = slab_and_block("step");
  input["mesh"] = parsed(R"({"box": {"size": [2, 1], "cells": [32, 16], "element": "tri3"}})");
  input["boundary"].erase(2);
  input["contact"].erase(1);
  for (const std::size_t k : {0, 1}) input["boundary"][k]["on"] = "top";
  input["contact"][0]["on"] = "bottom";
  input["solver"]["nested"] = false;
  const double plain = friction(solved(place, input), "floor");
  input["solver"]["nested"] = true;
  CHECK(friction(solved(place, input), "floor") == doctest::Approx(plain).epsilon(1e-4));
  input["mesh"]["adapt"] = {{"error", 0.1}};
  input["mesh"]["box"]["cells"] = {8, 4};
  solved(place, input);
}

TEST_CASE("points of two entries that differ in their reference keep it") {
  const Workplace place;
  nlohmann::json input = slab_and_block("step");
  input["mesh"] = parsed(R"({"box": {"size": [2, 1], "cells": [8, 4], "element": "quad4"}})");
  input["boundary"].erase(2);
  for (const std::size_t k : {0, 1}) input["boundary"][k]["on"] = "top";
  input["contact"][0]["on"] = parsed(R"({"box": [[0, 0], [1, 0]]})");
  input["contact"][1] = input["contact"][0];
  input["contact"][1]["on"] = parsed(R"({"box": [[1, 0], [2, 0]]})");
  input["contact"][1]["name"] = "other";
  for (const char* other : {"step", "start"}) {
    input["contact"][1]["friction"]["reference"] = other;
    solved(place, input);
  }
}

TEST_CASE("an obstacle that is pushed, withdrawn and pushed again") {
  const Workplace place;
  place.put("blocks.msh", two_blocks());
  nlohmann::json input = slab_and_block("step");
  input["contact"][0]["friction"] = {{"tresca", 1.0}, {"reference", "step"}};
  input["contact"][0]["force_controlled"] = parsed(R"({"force": 5, "direction": [0.3, 1]})");
  const std::vector<double> forces{1, 0, 0.5};
  for (std::size_t steps = 1; steps <= 3; ++steps) {
    nlohmann::json some = input;
    some["steps"] = nlohmann::json::array();
    for (std::size_t k = 0; k < steps; ++k)
      some["steps"].push_back({{"time", k + 1}, {"factors", {{"floor", forces[k]}}}});
    some["boundary"][0]["displacement"][1] = 0;
    some["boundary"][1]["displacement"][0] = 0;
    const nlohmann::json result = solved(place, some);
    const nlohmann::json &contact = result["contact"]["floor"], &last = result["load_steps"][steps - 1];
    CHECK(last["travel"]["floor"] == contact["travel"]);
    if (forces[steps - 1] > 0) {
      CHECK(double(contact["travel"]) > 0);
      continue;
    }
    CHECK(double(contact["travel"]) == 0);
    CHECK(double(contact["friction_force"][0]) == 0);  // the film is removed with its obstacle
    CHECK(double(result["max_displacement"]["value"]) < 1e-9);
  }
}

TEST_CASE("the verifier finds what is wrong of a history, in every load step") {
  const Workplace place;
  place.put("blocks.msh", two_blocks());
  for (const bool anew : {false, true}) {
    nlohmann::json input = slab_and_block("step");
    if (anew) {
      input["contact"][1].update(parsed(R"({"relinearise": true,
        "obstacle": {"sphere": {"centre": [5.4, -2], "radius": 2}}, "friction": {"coulomb": 0.3}})"));
      input["contact"][1]["motion"] = parsed(lift);
    }
    solved(place, input);
    const auto verified = [&](const std::string& name) {
      const Outcome outcome = place.run("verify " + name + " --output out");
      INFO(outcome.error, outcome.output);
      return outcome.exit_code;
    };
    // Another friction reference than that of the run.
    nlohmann::json changed = input;
    changed["contact"][0]["friction"]["reference"] = "start";
    place.put_json("changed.json", changed);
    CHECK(verified("changed.json") == 1);
    // Fields of another load step in place of the right ones, then missing fields.
    const std::string step = contents(place.path("out/body_step_1.vtu")),
                      end = contents(place.path("out/body_step_2.vtu"));
    place.put("out/body_step_1.vtu", end);
    CHECK(verified("case.json") == 1);
    std::filesystem::remove(place.path("out/body_step_1.vtu"));
    CHECK(verified("case.json") == 2);
    place.put("out/body_step_1.vtu", step);
    CHECK(verified("case.json") == 0);
    // Changed numbers of an earlier load step.
    const nlohmann::json result = place.json("out/result.json");
    nlohmann::json false_result = result;
    false_result["load_steps"][1]["friction_force"][0] =
        double(result["load_steps"][1]["friction_force"][0]) * 1.001;
    place.put_json("out/result.json", false_result);
    CHECK(verified("case.json") == 1);
  }
  // A run with slip relative to the start, presented as one relative to the previous step.
  nlohmann::json input = slab_and_block("start");
  solved(place, input);
  place.put_json("case.json", slab_and_block("step"));
  CHECK(place.run("verify case.json --output out").exit_code == 1);
}

TEST_CASE("a force that is not found is not reached") {
  const Workplace place;
  nlohmann::json input = parsed(R"({
    "mesh": {"box": {"size": [2, 1], "cells": [8, 4], "element": "quad4"}},
    "material": [{"on": "all", "young": 1000, "poisson": 0.3}],
    "boundary": [{"on": "top", "displacement": [0, 0]}],
    "contact": [{"on": "bottom", "name": "tool", "obstacle": {"plane": {"point": [0, -1e8], "normal": [0, 1]}},
                 "force_controlled": {"force": 1, "direction": [0, 1]}}],
    "output": {"report": false}})");
  for (const bool first : {true, false}) {
    // So far away that a small force is below the effect of rounding errors in the travel.
    input["steps"] = parsed(R"([{"time": 2, "factors": {"tool": 1e-7}}])");
    if (!first)
      input["steps"] =
          parsed(R"([{"time": 1, "factors": {"tool": 1}}, {"time": 2, "factors": {"tool": 1e-7}}])");
    for (const char* tolerance : {"1e-5", "1e-13"}) {
      place.put_json("case.json", input);
      const Outcome run =
          place.run("run case.json --output out --set solver.tolerance=" + std::string(tolerance));
      const nlohmann::json result = place.json("out/result.json");
      INFO(tolerance, result["message"].dump());
      CHECK(run.exit_code == 1);
      CHECK(result["status"] != "converged");
      const std::string message = result["message"];
      CHECK(message.find("the obstacle of tool is pushed by ") != std::string::npos);
      CHECK(message.find(" it bears ") != std::string::npos);
      if (first) CHECK(result["load_reached"] == 0.0);
      if (!first) CHECK(double(result["load_reached"]) < 2.0);
    }
  }
}
