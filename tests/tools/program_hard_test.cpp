// SPDX-License-Identifier: BSD-3-Clause
// Small cases of friction, gaps and unsupported bodies on which earlier versions failed, run as by users.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "../sanitized.hpp"
#include "program_runner.hpp"

using namespace kacanov::testing;
using nlohmann::json;

namespace {

struct Run {
  int exit_code = 0;
  json result;

  double number(const char* key, std::size_t component) const { return result.at(key).at(component); }
  int count(const char* key) const { return result.at(key); }
};

/// Returns the case of this name from tests/cases/hard.
json hard_case(const std::string& name) {
  std::ifstream file(KACANOV_HARD_CASES "/cases.json");
  json input = json::parse(file).at(name);
  if (input["mesh"].contains("file"))
    input["mesh"]["file"] = KACANOV_HARD_CASES "/" + input["mesh"]["file"].get<std::string>();
  return input;
}

/// Runs it with default settings.
Run run(const std::string& name) {
  const Workplace place;
  place.put_json("case.json", hard_case(name));
  const Outcome outcome = place.run("run case.json --ranks 1 --output " + place.path("out").string());
  CAPTURE(outcome.error);
  REQUIRE(place.has("out/result.json"));
  return {outcome.exit_code, place.json("out/result.json")};
}

Run converged(const std::string& name, int most_steps, int most_applications) {
  CAPTURE(name);
  const Run out = run(name);
  CHECK(out.exit_code == 0);
  CHECK(out.result.at("status") == "converged");
  CHECK(out.count("outer_iterations") <= most_steps);
  CHECK(out.count("operator_applications") <= most_applications);
  return out;
}

}  // namespace

TEST_CASE("a block that friction alone holds: nothing slips") {
  const Run block = converged("block_on_floor_coulomb", 10, 100);
  CHECK(block.count("slip_nodes") == 0);
  CHECK(block.number("contact_force", 2) == doctest::Approx(200.0));
  CHECK(block.number("friction_force", 0) == doctest::Approx(-40.0));
}

TEST_CASE("uniform shear under a bound that is not reached: uniform stress") {
  const Run patch = converged("uniform_shear_patch_coulomb", 10, 100);
  CHECK(patch.count("slip_nodes") == 0);
  CHECK(patch.number("friction_force", 0) == doctest::Approx(-10.0));
  CHECK(patch.result.at("max_contact_pressure").get<double>() == doctest::Approx(100.0).epsilon(1e-4));
}

TEST_CASE("quadratic facets: an even pressure reads as one, a shear below its bound sticks") {
  const Run pressed = converged("patch_tet10_pressure", 10, 100);
  CHECK(pressed.result.at("max_contact_pressure").get<double>() == doctest::Approx(100.0).epsilon(1e-5));
  const Run sheared = converged("shear_patch_tet10_tresca", 10, 100);
  CHECK(sheared.count("slip_nodes") == 0);
  CHECK(sheared.number("friction_force", 0) == doctest::Approx(-10.0));
  CHECK(sheared.result.at("max_contact_pressure").get<double>() == doctest::Approx(100.0).epsilon(1e-4));
}

TEST_CASE("a bracket on its foot, the rest held by friction") {
  const Run bracket = converged("bracket_linear_coulomb", 20, 200);
  // The tip has area 0.3 and load (10, 0, −50).
  CHECK(bracket.number("contact_force", 2) == doctest::Approx(15.0).epsilon(1e-4));
  CHECK(bracket.count("slip_nodes") > 0);
}

TEST_CASE("nodes in the edge between floor and wall belong to both") {
  // Floor and wall together carry the load.
  const Run cube = converged("cube_in_corner_coulomb", 15, 150);
  CHECK(cube.number("contact_force", 0) + cube.number("friction_force", 0) == doctest::Approx(50.0));
  CHECK(cube.number("contact_force", 2) + cube.number("friction_force", 2) == doctest::Approx(100.0));
  const Run small = converged("81_unknowns", 15, 150);
  CHECK(small.number("contact_force", 0) + small.number("friction_force", 0) == doctest::Approx(20.0));
  CHECK(small.number("contact_force", 2) + small.number("friction_force", 2) == doctest::Approx(100.0));
  converged("bracket", 30, 300);
}

TEST_CASE("a cantilever that just reaches its obstacle takes no thousands of ADMM iterations") {
  const Run touch = converged("cantilever_just_touches", 20, 400);
  CHECK(touch.number("contact_force", 2) == doctest::Approx(0.3445).epsilon(1e-3));
}

TEST_CASE("a slender cantilever whose tip touches, ADMM cut short" * doctest::skip(sanitized)) {
  const Run touch = converged("slender_cantilever_touch", 20, 400);
  CHECK(touch.number("contact_force", 2) == doctest::Approx(0.419).epsilon(1e-3));
}

TEST_CASE("slivers are named, and a factor solves where they leave multigrid nothing") {
  const Run sliver = converged("sliver", 15, 100);
  CHECK(sliver.number("contact_force", 2) == doctest::Approx(100.0));
  CHECK(sliver.number("friction_force", 0) == doctest::Approx(-13.0504).epsilon(1e-4));
}

TEST_CASE("nothing is tried for long where slivers leave a larger body no operator" *
          doctest::skip(sanitized)) {
  const Workplace place;
  json input = hard_case("sliver");
  input["mesh"]["refine"] = 3;
  input["solver"] = {{"nested", false}};
  place.put_json("case.json", input);
  const Outcome outcome = place.run("run case.json --ranks 1 --output " + place.path("out").string());
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.error.find("thinner than a millionth of their size") != std::string::npos);
  const json result = place.json("out/result.json");
  CHECK(result.at("message").get<std::string>().find("no linear problem could be solved") == 0);
  CHECK(result.at("load_reached") == 0.0);
}

TEST_CASE("bodies fall on to their obstacles") {
  // A width of 2 under 10; then a body hanging on a pin without friction.
  CHECK(converged("fall_through_gap", 15, 300).number("contact_force", 1) == doctest::Approx(20.0));
  const Run hook = converged("hook_on_pin_frictionless", 30, 6000);
  CHECK(hook.number("contact_force", 2) == doctest::Approx(-3.8334).epsilon(1e-4));
}

TEST_CASE("a body pulled off its only contact: no equilibrium, and nothing is solved") {
  const Run lifted = run("lift_off");
  CHECK(lifted.exit_code == 1);
  CHECK(lifted.result.at("status") == "not_converged");
  CHECK(lifted.count("operator_applications") == 0);
  const auto message = lifted.result.at("message").get<std::string>();
  CHECK(message.find("no equilibrium: the load lifts the body off") != std::string::npos);
  CHECK(message.find("translation along z") != std::string::npos);
}

TEST_CASE("a floor whose normal looks the wrong way is named by the failure that it brings") {
  const Workplace place;
  place.put("case.json", R"({
    "mesh": {"box": {"size": [1, 1, 1], "cells": [2, 2, 2], "element": "hex8"}},
    "material": [{"on": "all", "young": 210000, "poisson": 0.3}],
    "boundary": [{"on": "top", "traction": [0, 0, -100]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, -1]}},
                 "friction": {"coulomb": 0.3}}]})");
  const std::string file = place.path("case.json").string(), out = place.path("out").string();
  const Outcome outcome = place.run("run " + file + " --ranks 1 --output " + out);
  CHECK(outcome.exit_code == 1);
  const auto message = place.json("out/result.json").at("message").get<std::string>();
  CHECK(message.find("no equilibrium") == 0);
  CHECK(message.find("contact[0]: 4 of its 4 facets look away from the obstacle") != std::string::npos);
}

TEST_CASE("Tresca's friction at floor and wall does not cycle") { converged("tresca_floor_wall", 60, 1500); }
