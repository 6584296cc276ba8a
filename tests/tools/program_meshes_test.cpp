// SPDX-License-Identifier: BSD-3-Clause
// Whole runs on meshes of every source: boxes, files, refined and quadratic meshes, nested starts from
// coarser meshes.
#include <doctest/doctest.h>

#include "../sanitized.hpp"
#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// A sphere pressed into a block whose mesh is refined where the error is large.
nlohmann::json press() {
  return nlohmann::json::parse(R"({
    "mesh": {"box": {"size": [1, 1, 1], "cells": [3, 3, 3], "element": "tet10"}, "adapt": {"error": 0.12}},
    "material": [{"on": "all", "young": 210000, "poisson": 0.3, "law": {"type": "logarithmic", "yield_stress": 250}}],
    "boundary": [{"on": "bottom", "displacement": [0, 0, 0]}],
    "contact": [{"on": "top", "obstacle": {"sphere": {"centre": [0.5, 0.5, 2.995], "radius": 2}}}],
    "probe": [[0.5, 0.5, 1]]})");
}

}  // namespace

TEST_CASE("quadrilaterals bear the beam as triangles do, and are drawn as such") {
  const Workplace place;
  nlohmann::json quads = small_beam(), triangles = small_beam();
  quads["mesh"]["box"]["element"] = "quad4";
  quads["material"][0]["bbar"] = true;
  triangles["mesh"]["box"]["cells"] = {64, 16};
  place.put_json("quads.json", quads);
  place.put_json("triangles.json", triangles);
  for (const char* run : {"run quads.json", "run triangles.json"}) {
    const Outcome outcome = place.run(run);
    INFO("error: ", outcome.error);
    CHECK(outcome.exit_code == 0);
  }
  const nlohmann::json coarse = place.json("results/quads/result.json"),
                       fine = place.json("results/triangles/result.json");
  CHECK(coarse["elements"] == 64);
  CHECK(coarse["unknowns"] == 170);
  CHECK(coarse["contact_nodes"] == 16);
  CHECK(coarse["certificate"]["penetration"].get<double>() <= 1e-6);
  CHECK(coarse["probe"][0][1].get<double>() ==
        doctest::Approx(fine["probe"][0][1].get<double>()).epsilon(0.05));
  CHECK(coarse["contact_force"][1].get<double>() ==
        doctest::Approx(fine["contact_force"][1].get<double>()).epsilon(0.05));
}

TEST_CASE("a large box starts from coarser ones: the same answer for fewer applications" *
          doctest::skip(sanitized)) {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"]["box"]["cells"] = {256, 64};
  place.put_json("beam.json", beam);
  for (const char* run : {"run beam.json --output nested --ranks 2", "run beam.json --output one --ranks 1",
                          "run beam.json --output alone --set solver.nested=false"}) {
    const Outcome outcome = place.run(run);
    INFO("error: ", outcome.error);
    CHECK(outcome.exit_code == 0);
  }
  const nlohmann::json nested = place.json("nested/result.json"), one = place.json("one/result.json"),
                       alone = place.json("alone/result.json");
  CHECK(!alone.contains("nested"));
  REQUIRE(nested["nested"].size() == 4);
  CHECK(nested["nested"][0]["unknowns"] == 17 * 5 * 2);
  CHECK(nested["nested"][3]["unknowns"] == 129 * 33 * 2);
  CHECK(nested["operator_applications"] < alone["operator_applications"]);
  for (const nlohmann::json& other : {one, alone})
    CHECK(nested["probe"][0][1].get<double>() ==
          doctest::Approx(other["probe"][0][1].get<double>()).epsilon(1e-5));
}

TEST_CASE("a mesh file is refined with its groups, and solved from the coarse mesh on") {
  const Workplace place;
  place.put("bar.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"left\"\n1 2 \"right\"\n"
            "2 3 \"bar\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n"
            "6 2 1 0\n$EndNodes\n$Elements\n4\n1 1 2 1 1 1 4\n2 1 2 2 2 3 6\n3 3 2 3 3 1 2 5 4\n"
            "4 3 2 3 3 2 3 6 5\n$EndElements\n");
  place.put_json("bar.json", nlohmann::json::parse(R"({
    "mesh": {"file": "bar.msh", "refine": 3},
    "material": [{"on": "bar", "young": 1.0, "poisson": 0.0, "law": {"type": "linear"}}],
    "boundary": [{"on": "left", "displacement": [0, 0]}, {"on": "right", "traction": [0.1, 0]}],
    "probe": [[2, 0.5]]})"));
  const Outcome outcome = place.run("run bar.json");
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 0);
  const nlohmann::json result = place.json("results/bar/result.json");
  CHECK(result["elements"] == 2 * 64);
  CHECK(result["nested"].size() == 3);
  CHECK(result["probe"][0][0].get<double>() == doctest::Approx(0.2).epsilon(1e-6));
}

TEST_CASE("a refined box is the box with twice the cells") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  place.put_json("fine.json", beam);
  beam["mesh"] = {{"box", {{"size", {4, 1}}, {"cells", {8, 2}}}}, {"refine", 1}};
  place.put_json("twice.json", beam);
  for (const char* run : {"run fine.json", "run twice.json"}) CHECK(place.run(run).exit_code == 0);
  CHECK(place.json("results/fine/result.json")["probe"] == place.json("results/twice/result.json")["probe"]);
  const Outcome refused = place.run("check twice.json --set mesh.refine=11");
  CHECK(refused.exit_code == 2);
  CHECK(refused.error.find("mesh.refine: expected at most 10") != std::string::npos);
}

TEST_CASE("quadratic elements are made of a file's linear ones, and of a box's") {
  const Workplace place;
  nlohmann::json bar = {
      {"mesh", {{"box", {{"size", {2, 1, 1}}, {"cells", {4, 2, 2}}, {"element", "tet10"}}}}},
      {"material", {{{"on", "all"}, {"young", 1.0}, {"poisson", 0.3}, {"law", {{"type", "linear"}}}}}},
      {"boundary",
       {{{"on", "left"}, {"displacement", {0, 0, 0}}}, {{"on", "right"}, {"traction", {0, 0, 1e-3}}}}},
      {"probe", {{2, 1, 1}}}};
  place.put_json("box10.json", bar);
  bar["mesh"]["box"].erase("element");
  bar["mesh"]["order"] = 2;
  place.put_json("box4.json", bar);
  for (const char* run : {"run box10.json", "run box4.json"}) CHECK(place.run(run).exit_code == 0);
  CHECK(place.json("results/box4/result.json")["mesh"]["element"] == "tet10");
  CHECK(place.json("results/box4/result.json")["probe"] == place.json("results/box10/result.json")["probe"]);
  bar["mesh"] = {{"file", KACANOV_HARD_CASES "/hook.msh"}, {"order", 2}};
  bar["boundary"][0]["on"] = "top";
  bar["boundary"][1]["on"] = "side";
  bar.erase("probe");
  place.put_json("hook.json", bar);
  const Outcome hook = place.run("run hook.json");
  INFO("error: ", hook.error);
  CHECK(hook.exit_code == 0);
  CHECK(place.json("results/hook/result.json")["mesh"]["element"] == "tet10");
  CHECK(place.run("verify hook.json --output results/hook").exit_code == 0);
  CHECK(place.run("check hook.json --set mesh.order=3").error.find("mesh.order: expected 1 or 2") !=
        std::string::npos);
  CHECK(place.run("check box4.json --set mesh.box.element=hex8").error.find("mesh.order: 2 makes tet10") !=
        std::string::npos);
}

TEST_CASE("an adapted mesh meets the error asked for, with fewer unknowns than an even one" *
          doctest::skip(sanitized)) {
  const Workplace place;
  nlohmann::json even_press = press();
  place.put_json("press.json", even_press);
  even_press["mesh"].erase("adapt");
  even_press["mesh"]["box"]["cells"] = {10, 10, 10};
  even_press["solver"]["nested"] = false;
  place.put_json("even.json", even_press);
  for (const char* run : {"run press.json --output one --ranks 1", "run press.json --output two --ranks 2",
                          "run even.json --output even", "verify press.json --output two"}) {
    const Outcome outcome = place.run(run);
    INFO("error: ", outcome.error);
    CHECK(outcome.exit_code == 0);
  }
  const nlohmann::json one = place.json("one/result.json"), two = place.json("two/result.json"),
                       even = place.json("even/result.json");
  CHECK(one["discretisation"]["energy"] <= 0.12);
  CHECK(even["discretisation"]["energy"] > one["discretisation"]["energy"]);
  CHECK(2 * one["unknowns"].get<int>() < even["unknowns"].get<int>());
  REQUIRE(one["nested"].size() > 2);
  CHECK(one["nested"][0]["error"] > one["nested"].back()["error"]);
  CHECK(one["nested"].back()["error"].get<double>() ==
        doctest::Approx(one["discretisation"]["energy"].get<double>()).epsilon(0.01));
  CHECK(two["unknowns"] == one["unknowns"]);
  CHECK(two["contact_force"][2].get<double>() ==
        doctest::Approx(one["contact_force"][2].get<double>()).epsilon(1e-5));
  CHECK(even["contact_force"][2].get<double>() ==
        doctest::Approx(one["contact_force"][2].get<double>()).epsilon(0.1));
}

TEST_CASE("a first mesh that does not see the obstacle is refined until it does" * doctest::skip(sanitized)) {
  const Workplace place;
  nlohmann::json needle = press();
  needle["mesh"] = {{"box", {{"size", {1, 1, 1}}, {"cells", {2, 2, 2}}, {"element", "tet10"}}},
                    {"adapt", {{"error", 0.2}}}};
  needle["contact"][0]["obstacle"] = {{"sphere", {{"centre", {0.33, 0.38, 1.098}}, {"radius", 0.1}}}};
  place.put_json("needle.json", needle);
  const Outcome outcome = place.run("run needle.json");
  INFO("error: ", outcome.error);
  REQUIRE(outcome.exit_code == 0);
  const nlohmann::json result = place.json("results/needle/result.json");
  CHECK(result["contact_force"][2].get<double>() < 0.0);
  CHECK(result["discretisation"]["energy"] <= 0.2);
  CHECK_FALSE(result["nested"][0].contains("error"));  // the body is unstrained there
  CHECK(result["warnings"].dump().find("nothing says where") == std::string::npos);
  // A message reports that the limit prevents it.
  needle["mesh"]["adapt"]["most_unknowns"] = 100;
  place.put_json("needle.json", needle);
  CHECK(place.run("run needle.json").exit_code == 0);
  CHECK(place.json("results/needle/result.json")["warnings"].dump().find("goes through an obstacle") !=
        std::string::npos);
}

TEST_CASE("an adapted mesh stays below the unknowns allowed, and a run that was stopped goes on with it") {
  const Workplace place;
  place.put_json("press.json", press());
  const Outcome limited = place.run("run press.json --output less --set mesh.adapt.most_unknowns=2000");
  CHECK(limited.exit_code == 0);
  CHECK(place.json("less/result.json")["unknowns"] <= 2000);
  CHECK(place.json("less/result.json")["warnings"].dump().find("mesh.adapt.most_unknowns = 2000: ") !=
        std::string::npos);
  // A stopped run continues on its refined mesh.
  CHECK(place.run("run press.json --output less --set solver.max_outer=1 --set mesh.adapt.most_unknowns=2000")
            .exit_code == 1);
  CHECK(place
            .run("run press.json --output less --restart --set solver.max_outer=1 "
                 "--set mesh.adapt.most_unknowns=2000")
            .error.find("--restart") == std::string::npos);
  for (const auto& [options, message] : {std::pair{"run press.json --set mesh.adapt.error=1",
                                                   "mesh.adapt.error: expected a number above 0 and below 1"},
                                         std::pair{"run press.json --set mesh.box.element=hex8",
                                                   "mesh.adapt: expected tri3, tet4 or tet10, got hex8"},
                                         std::pair{"partition press.json --ranks 2 --output parts",
                                                   "mesh.adapt: expected a mesh that stays"}}) {
    const Outcome refused = place.run(options);
    CHECK(refused.exit_code == 2);
    INFO(refused.error);
    CHECK(refused.error.find(message) != std::string::npos);
  }
}
