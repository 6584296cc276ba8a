// SPDX-License-Identifier: BSD-3-Clause
// Supports in oblique directions: symmetry planes and rotated frames against axis-aligned ones and
// closed-form solutions, on any number of ranks, verified from the files; bad input.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "turned_body.hpp"
#include "verified_run.hpp"

using namespace kacanov;
using namespace kacanov::testing;
using nlohmann::json;

namespace {

/// A plastic block between three symmetry planes, sheared, with an obstacle before its top.
json block(const Point& shear, const Point& up, const Point& top) {
  json block = parsed(R"({
    "mesh": {"file": "body.msh"},
    "material": [{"on": "all", "young": 200, "poisson": 0.3, "yield_stress": 1, "tangent_modulus": 20}],
    "boundary": [{"on": "left", "normal": 0}, {"on": "front", "normal": 0},
                 {"on": "bottom", "name": "floor", "normal": -0.002}, {"on": "right"}],
    "contact": [{"on": "top", "name": "lid", "obstacle": {"plane": {}}, "friction": {"coulomb": 0.3}}],
    "solver": {"tolerance": 1e-8}, "output": {"report": false}})");
  block["boundary"][3]["traction"] = list(shear);
  block["contact"][0]["obstacle"]["plane"] = {{"point", list(top)}, {"normal", list(up)}};
  block["probe"] = json::array({list(top)});
  return block;
}

}  // namespace

TEST_CASE("a body that is turned with its planes of symmetry answers as it did on the axes") {
  const Workplace place;
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(static_cast<int>(type));
    const BoxSpec box{{1, 1.5, 1}, {3, 3, 3}, type};
    const Point shear{-0.3, 0.4, 0.1}, down{0, 0, -1}, top{1, 1.5, 1};
    put_mesh(place, box, [](const Point& x) { return x; });
    // The floor moves up by 0.002, against its outer normal.
    const json straight = solved(place, block(shear, down, top));
    CHECK(straight["plastic_elements"] > 0);
    put_mesh(place, box, turned);
    for (const char* ranks : {"1", "2", "3"}) {
      if (ranks[0] == '3' && type != ElementType::tet4) continue;
      const json slanting = solved(place, block(turned(shear), turned(down), turned(top)), ranks);
      CHECK(slanting["max_von_mises"].get<double>() ==
            doctest::Approx(straight["max_von_mises"].get<double>()).epsilon(1e-6));
      CHECK(distance(point_of(slanting["probe"][0]), turned(point_of(straight["probe"][0]))) < 1e-9);
      for (const char* part :
           {"/reaction/floor/force", "/contact/lid/force", "/contact/lid/friction_force"}) {
        CAPTURE(part);
        const json::json_pointer at(part);
        CHECK(distance(point_of(slanting[at]), turned(point_of(straight[at]))) < 1e-6);
      }
    }
  }
}

TEST_CASE("a sector of a tube under pressure, between two planes of symmetry: Lamé's solution") {
  const Workplace place;
  const double angle = M_PI / 5, a = 1, b = 2, p = 0.5, modulus = 200, nu = 0.3;
  put_mesh(place, {{1, angle, 0.2}, {12, 8, 1}, ElementType::hex8}, [](const Point& x) {
    return Point{(1 + x[0]) * std::cos(x[1]), (1 + x[0]) * std::sin(x[1]), x[2]};
  });
  json tube = parsed(R"({
    "mesh": {"file": "body.msh"}, "material": [{"on": "all", "young": 200, "poisson": 0.3}],
    "boundary": [{"on": "front", "normal": 0}, {"on": "back", "normal": 0}, {"on": "bottom", "normal": 0},
                 {"on": "top", "normal": 0}, {"on": "left", "pressure": 0.5}],
    "solver": {"tolerance": 1e-8}, "output": {"report": false}})");
  tube["probe"] = json::array();
  for (const double r : {1.0, 2.0}) tube["probe"].push_back({r * std::cos(angle), r * std::sin(angle), 0.1});
  const json result = solved(place, tube, "2");
  for (std::size_t k = 0; k < 2; ++k) {
    const double r = k == 0 ? a : b;
    const double u = (1 + nu) / modulus * p * a * a / (b * b - a * a) * ((1 - 2 * nu) * r + b * b / r);
    const Point exact{u * std::cos(angle), u * std::sin(angle), 0};
    CHECK(distance(point_of(result["probe"][k]), exact) < 0.01 * u);
  }
}

TEST_CASE("displacements in a frame are those along its axes, and grow with load curves") {
  const Workplace place;
  json input = parsed(R"({
    "mesh": {"box": {"size": [1, 1, 1], "cells": [2, 2, 2], "element": "hex8"}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3}],
    "boundary": [{"on": "bottom", "displacement": [0, 0, 0]},
                 {"on": "top", "name": "grip", "frame": [[3, 0, 4], [0, 2, 0], [-4, 0, 3]],
                  "displacement": [0.01, null, null]}],
    "steps": [{"time": 1, "factors": {"grip": 1}}, {"time": 2, "factors": {"grip": 0.5}}],
    "probe": [[1, 0.3, 1]], "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  const json result = solved(place, input, "2");
  const Point u = point_of(result["probe"][0]), force = point_of(result["reaction"]["grip"]["force"]);
  CHECK(0.6 * u[0] + 0.8 * u[2] == doctest::Approx(0.005).epsilon(1e-9));
  CHECK(force[0] / force[2] == doctest::Approx(0.75).epsilon(1e-6));
  CHECK(std::abs(force[1]) < 1e-7);
  // Three directions fix the position.
  input["boundary"][1]["displacement"] = parsed("[0.01, 0, 0.02]");
  const Point fixed = point_of(solved(place, input)["probe"][0]);
  CHECK(distance(fixed, {0.5 * (0.006 - 0.016), 0, 0.5 * (0.008 + 0.012)}) < 1e-12);
}

TEST_CASE("what cannot be held is refused") {
  const Workplace place;
  const auto refused = [&](const char* entry) {
    json input = parsed(R"({
      "mesh": {"box": {"size": [1, 1, 1], "cells": [2, 2, 2], "element": "hex8"}},
      "material": [{"on": "all", "young": 200, "poisson": 0.3}],
      "boundary": [{"on": "bottom", "displacement": [0, 0, 0]}]})");
    input["boundary"].push_back(parsed(entry));
    place.put_json("case.json", input);
    const Outcome outcome = place.run("check case.json");
    CHECK(outcome.exit_code == 2);
    return outcome.error;
  };
  const auto has = [](const std::string& text, const char* part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(refused(R"({"on": "all", "normal": 0})"), "boundary[1].normal: expected flat facets");
  has(refused(R"({"on": "top", "normal": "x"})"), "boundary[1].normal: expected a number, got \"x\"");
  has(refused(R"({"on": "top", "pressure": 1, "frame": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]})"),
      "boundary[1].frame: expected this key beside displacement alone");
  has(refused(R"({"on": "top", "displacement": [0, 0, 0], "frame": [[1, 0, 0], [1, 1, 0], [0, 0, 1]]})"),
      "boundary[1].frame[1]: expected an axis orthogonal to those before, got [1,1,0]");
  has(refused(R"({"on": "top", "displacement": [0, 0, 0], "frame": [[1, 0, 0]]})"),
      "boundary[1].frame: expected a list of 2 or 3 axes");
  has(refused(
          R"({"on": "left", "displacement": [0.1, null, null], "frame": [[1, 0, 1], [0, 1, 0], [1, 0, -1]]})"),
      "is given a displacement that other entries do not let it have");
}
