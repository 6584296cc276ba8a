// SPDX-License-Identifier: BSD-3-Clause
// Springs and temperature in cases: closed-form solutions on any number of ranks, verified from the files;
// bad input.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "verified_run.hpp"

using namespace kacanov::testing;
using nlohmann::json;

namespace {

/// A bar of 1 × 1 × 2 with rollers on three sides and a probe in its free corner; no load.
json bar(const std::string& element, double poisson) {
  json bar = parsed(R"({
    "mesh": {"box": {"size": [1, 1, 2], "cells": [2, 2, 4]}},
    "material": [{"on": "all", "young": 200}],
    "boundary": [{"on": "left", "displacement": [0, null, null]}, {"on": "front", "displacement": [null, 0, null]}],
    "probe": [[1, 1, 2], [0.5, 0.5, 0]], "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  bar["mesh"]["box"]["element"] = element;
  bar["material"][0]["poisson"] = poisson;
  return bar;
}

void add(json& bar, const char* entry) { bar["boundary"].push_back(parsed(entry)); }

json solved(const json& input, const std::string& ranks = "1") {
  return kacanov::testing::solved(Workplace(), input, ranks);
}

std::array<double, 3> vector(const json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

void check_vector(const json& list, const std::array<double, 3>& expected, double accuracy) {
  for (std::size_t c = 0; c < 3; ++c) {
    CAPTURE(c);
    CHECK(std::abs(vector(list)[c] - expected[c]) < accuracy);
  }
}

std::string refused(const json& input) {
  const Workplace place;
  place.put_json("case.json", input);
  const Outcome outcome = place.run("check case.json");
  CHECK(outcome.exit_code == 2);
  return outcome.error;
}

}  // namespace

TEST_CASE("a bar on springs: every element, a stiffness by component and along the normal, on any ranks") {
  const double p = 3, k = 40, height = 2;
  for (const char* element : {"tet4", "tet10", "hex8"})
    for (const char* spring : {"40", "[0, 0, 40]"})
      for (const char* ranks : {"1", "2", "3"}) {
        CAPTURE(element);
        CAPTURE(spring);
        if (ranks[0] != '1' && element[0] == 'h') continue;
        json input = bar(element, 0.0);
        add(input, R"({"on": "top", "pressure": 3})");
        add(input, (R"({"on": "bottom", "name": "bed", "spring": )" + std::string(spring) + "}").c_str());
        const json result = solved(input, ranks);
        check_vector(result["probe"][1], {0, 0, -p / k}, 1e-9);
        check_vector(result["probe"][0], {0, 0, -p / k - p * height / 200}, 1e-9);
        check_vector(result["reaction"]["bed"]["force"], {0, 0, p}, 1e-7);
        check_vector(result["reaction"]["bed"]["moment"], {p / 2, -p / 2, 0}, 1e-7);
      }
}

TEST_CASE("a body that springs alone hold moves as a whole where its load acts on their bed") {
  for (const char* element : {"tet4", "tet10", "hex8"}) {
    CAPTURE(element);
    json input = bar(element, 0.3);
    input["boundary"] = json::array();
    add(input, R"({"on": "bottom", "spring": [10, 20, 40]})");
    add(input, R"({"on": "bottom", "traction": [1, 1, 1]})");
    const json result = solved(input);
    for (const json& probe : result["probe"]) check_vector(probe, {0.1, 0.05, 0.025}, 1e-9);
    CHECK(result["max_von_mises"] < 1e-6);
    CHECK(result["warnings"].dump().find("only the contact holds") == std::string::npos);
  }
}

TEST_CASE("a clamped strip on Winkler's bed") {
  // Elastic foundation, EI w'''' + k w = q; quadratic tetrahedra, slender enough for beam theory.
  const double l = 10, h = 0.5, young = 200, k = 0.05, q = 0.001;
  json input = bar("tet10", 0.0);
  input["mesh"]["box"] = parsed(R"({"size": [20, 0.5, 0.5], "cells": [40, 1, 1], "element": "tet10"})");
  input["boundary"] = json::array();
  for (const char* side : {"left", "right"})
    input["boundary"].push_back({{"on", side}, {"displacement", {0, 0, 0}}});
  add(input, R"({"on": "bottom", "spring": 0.05})");
  add(input, R"({"on": "top", "pressure": 0.001})");
  input["probe"] = parsed("[[10, 0.25, 0.25], [5, 0.25, 0.25]]");
  const double beta = std::pow(k / (4 * young * h * h * h / 12), 0.25), b = beta * l;
  // w = q/k (1 − A cosh cos − B sinh sin) about the middle, w = w' = 0 at the ends.
  const double cc = std::cosh(b) * std::cos(b), ss = std::sinh(b) * std::sin(b),
               dc = std::sinh(b) * std::cos(b) - std::cosh(b) * std::sin(b),
               ds = std::cosh(b) * std::sin(b) + std::sinh(b) * std::cos(b), det = cc * ds - ss * dc;
  const auto exact = [&](double x) {
    const double s = beta * x, a = ds / det, c = -dc / det;
    return -q / k * (1 - a * std::cosh(s) * std::cos(s) - c * std::sinh(s) * std::sin(s));
  };
  const json result = solved(input);
  CHECK(result["probe"][0][2].get<double>() == doctest::Approx(exact(0)).epsilon(0.02));
  CHECK(result["probe"][1][2].get<double>() == doctest::Approx(exact(5)).epsilon(0.02));
}

TEST_CASE("springs share the load with an obstacle and a plastic body, and with friction") {
  json input = bar("hex8", 0.3);
  input["material"][0]["yield_stress"] = 1.0;
  input["material"][0]["tangent_modulus"] = 20.0;
  input["boundary"] = json::array();
  add(input, R"({"on": "left", "name": "bed", "spring": [5, 3, 2]})");
  add(input, R"({"on": "top", "traction": [0.2, 0, -2]})");
  add(input, R"({"on": {"box": [[0, 0, 2], [0, 1, 2]]}, "node_spring": [1, 0, 0]})");
  input["boundary"][2]["on"] = "right";
  input["contact"] = parsed(R"([{"on": "bottom", "name": "floor", "obstacle": {"plane": {"point": [0, 0, 0],
                                 "normal": [0.1, 0, 1]}}, "friction": {"coulomb": 0.3}}])");
  for (const char* ranks : {"1", "3"}) {
    const json result = solved(input, ranks);
    CHECK(result["plastic_elements"] > 0);
    std::array<double, 3> sum{};
    for (const char* list : {"contact", "reaction", "load"})
      for (const auto& [name, entry] : result[list].items())
        for (std::size_t c = 0; c < 3; ++c) sum[c] += vector(entry["force"])[c];
    for (const double s : sum) CHECK(std::abs(s) < 1e-7);
  }
}

TEST_CASE("warmth without hindrance is strain without stress; held at both ends it is stress") {
  const double rise = 100, alpha = 1e-5, young = 200;
  for (const char* element : {"tet4", "tet10", "hex8"})
    for (const char* ranks : {"1", "2"}) {
      CAPTURE(element);
      json input = bar(element, 0.3);
      input["material"][0]["expansion"] = alpha;
      add(input, R"({"on": "bottom", "name": "floor", "displacement": [null, null, 0]})");
      add(input, R"({"on": "all", "temperature": 100})");
      json result = solved(input, ranks);
      check_vector(result["probe"][0], {alpha * rise, alpha * rise, 2 * alpha * rise}, 1e-11);
      CHECK(result["max_von_mises"] < 1e-8 * young * alpha * rise);
      CHECK(result["max_von_mises_nodal"] < 1e-8 * young * alpha * rise);
      add(input, R"({"on": "top", "displacement": [null, null, 0]})");
      result = solved(input, ranks);
      check_vector(result["reaction"]["floor"]["force"], {0, 0, young * alpha * rise}, 1e-8);
      CHECK(result["max_von_mises"].get<double>() == doctest::Approx(young * alpha * rise).epsilon(1e-7));
      check_vector(result["probe"][0], {1.3 * alpha * rise, 1.3 * alpha * rise, 0}, 1e-11);
    }
}

TEST_CASE("a bar held at both ends yields by warmth; load curves cool it again") {
  json input = bar("hex8", 0.3);
  input["material"][0].update(parsed(R"({"expansion": 2e-5, "yield_stress": 0.3, "tangent_modulus": 20})"));
  add(input, R"({"on": "bottom", "name": "floor", "displacement": [null, null, 0]})");
  add(input, R"({"on": "top", "displacement": [null, null, 0]})");
  add(input, R"({"on": "all", "name": "warmth", "temperature": 100})");
  const double stress = 0.3 + 20 * (2e-5 * 100 - 0.3 / 200);
  json result = solved(input);
  CHECK(vector(result["reaction"]["floor"]["force"])[2] == doctest::Approx(stress).epsilon(1e-6));
  input["steps"] =
      parsed(R"([{"time": 1, "factors": {"warmth": 1}}, {"time": 2, "factors": {"warmth": 0.5}}])");
  result = solved(input);
  CHECK(vector(result["reaction"]["floor"]["force"])[2] == doctest::Approx(200 * 1e-3).epsilon(1e-6));
}

TEST_CASE("plane strain: warmth stretches by 1 + ν, and presses across") {
  json input = parsed(R"({
    "mesh": {"box": {"size": [2, 1], "cells": [4, 2], "element": "quad4"}},
    "material": [{"on": "all", "young": 200, "poisson": 0.25, "expansion": 1e-5}],
    "boundary": [{"on": "left", "displacement": [0, null]}, {"on": "bottom", "displacement": [null, 0]},
                 {"on": "all", "temperature": 100}],
    "probe": [[2, 1]], "solver": {"tolerance": 1e-9}})");
  for (const char* element : {"quad4", "tri3"}) {
    input["mesh"]["box"]["element"] = element;
    const json result = solved(input);
    CHECK(result["probe"][0][0].get<double>() == doctest::Approx(2 * 1.25e-3).epsilon(1e-8));
    CHECK(result["probe"][0][1].get<double>() == doctest::Approx(1.25e-3).epsilon(1e-8));
    CHECK(result["max_von_mises"].get<double>() == doctest::Approx(0.2).epsilon(1e-7));
  }
}

TEST_CASE("a prescribed displacement closes a slanting gap once") {
  json input = bar("hex8", 0.3);
  input["boundary"] = json::array();
  input["solver"]["tolerance"] = 1e-6;
  input["material"][0]["young"] = 1;
  add(input, R"({"on": "bottom", "displacement": [0.02, 0, null]})");
  add(input, R"({"on": "top", "traction": [0, 0, -0.01]})");
  input["contact"] = parsed(R"([{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, -0.1],
                                 "normal": [-0.3, 0, 1]}}}])");
  const json result = solved(input);
  CHECK(result["probe"][1][2].get<double>() == doctest::Approx(-0.1 + 0.3 * 0.52).epsilon(1e-3));
}

TEST_CASE("parts hold springs and temperatures, to the same bits") {
  const Workplace place;
  json input = bar("tet4", 0.3);
  input["material"][0]["expansion"] = 1e-5;
  add(input, R"({"on": "bottom", "spring": 5})");
  add(input, R"({"on": "all", "temperature": 100})");
  place.put_json("case.json", input);
  REQUIRE(place.run("partition case.json --ranks 2 --output parts").exit_code == 0);
  REQUIRE(place.run("run case.json --parts parts --output a").exit_code == 0);
  REQUIRE(place.run("run case.json --ranks 2 --output b").exit_code == 0);
  CHECK(contents(place.path("a/body.vtu")) == contents(place.path("b/body.vtu")));
  CHECK(place.json("a/result.json")["reaction"] == place.json("b/result.json")["reaction"]);
}

TEST_CASE("forces of a plane body are those of its thickness, in and out") {
  const double thickness = 8;
  json input = parsed(R"({
    "mesh": {"box": {"size": [2, 1], "cells": [8, 4], "element": "quad4"}}, "plane": "stress", "thickness": 8,
    "material": [{"on": "all", "young": 200, "poisson": 0.25}],
    "boundary": [{"on": "left", "name": "wall", "displacement": [0, null]},
                 {"on": "right", "name": "pull", "total_force": [4, 0]},
                 {"on": "top", "name": "down", "traction": [0, -0.5]}, {"on": "right", "node_spring": [0, 0.5]}],
    "contact": [{"on": "bottom", "name": "floor", "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}},
                 "friction": {"coulomb": 0.1}}],
    "probe": [[2, 1]], "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  const json thick = solved(input, "2");
  CHECK(thick["load"]["pull"]["force"][0].get<double>() == doctest::Approx(4));
  CHECK(thick["load"]["down"]["force"][1].get<double>() == doctest::Approx(-0.5 * 2 * thickness));
  CHECK(thick["mesh"]["volume"].get<double>() == doctest::Approx(2 * thickness));
  CHECK(thick["contact"]["floor"]["area"].get<double>() == doctest::Approx(2 * thickness));
  // The same body with thickness 1 under an eighth of the forces.
  input.erase("thickness");
  input["boundary"][1]["total_force"] = {4 / thickness, 0};
  input["boundary"][3]["node_spring"] = {0, 0.5 / thickness};
  const json thin = solved(input, "2");
  CHECK(thin["probe"] == thick["probe"]);
  for (const char* list : {"contact", "reaction", "load"})
    for (const auto& [name, entry] : thin[list].items())
      for (const char* key : {"force", "moment"})
        for (std::size_t c = 0; c < entry[key].size(); ++c)
          CHECK(thickness * entry[key][c].get<double>() ==
                doctest::Approx(thick[list][name][key][c].get<double>()).epsilon(1e-9));
  CHECK(thin["max_von_mises"] == thick["max_von_mises"]);
  // A force-controlled obstacle in plane strain.
  input["thickness"] = thickness;
  input["plane"] = "strain";
  input["boundary"] = parsed(R"([{"on": "bottom", "name": "base", "displacement": [0, 0]}])");
  input["contact"] =
      parsed(R"([{"on": "top", "name": "punch", "obstacle": {"plane": {"point": [0, 1.5], "normal": [0, -1]}},
                                 "force_controlled": {"force": 3, "direction": [0, -1]}}])");
  input["solver"]["tolerance"] = 1e-6;
  for (const double force : {0.01, 3.0, 50.0}) {
    input["contact"][0]["force_controlled"]["force"] = force;
    const json pushed = solved(input);
    CHECK(pushed["contact"]["punch"]["force"][1].get<double>() == doctest::Approx(-force).epsilon(1e-4));
    CHECK(pushed["reaction"]["base"]["force"][1].get<double>() == doctest::Approx(force).epsilon(1e-4));
  }
  input["thickness"] = -1;
  CHECK(refused(input).find("thickness: expected a number > 0, got -1") != std::string::npos);
  input["thickness"] = 2;
  input["plane"] = "axisymmetric";
  CHECK(refused(input).find("thickness: expected none with an axisymmetric mesh") != std::string::npos);
  input = bar("hex8", 0.3);
  input["thickness"] = 2;
  CHECK(refused(input).find("thickness: expected 1, or a mesh in 2D, got one in 3D") != std::string::npos);
}

TEST_CASE("several obstacles are pushed, and each has its own force") {
  // Two balls side by side on a block, and a jaw at each end of it; with friction.
  json input = parsed(R"({
    "mesh": {"box": {"size": [4, 1], "cells": [16, 4], "element": "quad4"}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3}],
    "boundary": [{"on": "bottom", "name": "base", "displacement": [null, 0]}],
    "contact": [
      {"on": {"box": [[0, 1], [2, 1]]}, "name": "a", "obstacle": {"sphere": {"centre": [1.5, 3], "radius": 1.9}},
       "force_controlled": {"force": 0.5, "direction": [0, -1]}},
      {"on": {"box": [[2, 1], [4, 1]]}, "name": "b", "obstacle": {"sphere": {"centre": [2.5, 3], "radius": 1.9}},
       "force_controlled": {"force": 0.2, "direction": [0, -1]}},
      {"on": "left", "name": "jaw", "obstacle": {"plane": {"point": [-0.1, 0], "normal": [1, 0]}},
       "friction": {"coulomb": 0.2}, "force_controlled": {"force": 1, "direction": [1, 0]}},
      {"on": "right", "name": "stop", "obstacle": {"plane": {"point": [4, 0], "normal": [-1, 0]}}}]})");
  const auto force = [](const json& result, const char* name, std::size_t c) {
    return result["contact"][name]["force"][c].get<double>();
  };
  for (const char* ranks : {"1", "2"}) {
    const json result = solved(input, ranks);
    CHECK(force(result, "a", 1) == doctest::Approx(-0.5).epsilon(1.1e-5));
    CHECK(force(result, "b", 1) == doctest::Approx(-0.2).epsilon(1.1e-5));
    CHECK(force(result, "jaw", 0) == doctest::Approx(1).epsilon(1.1e-5));
    for (const char* name : {"a", "b", "jaw"}) CHECK(result["contact"][name]["travel"].get<double>() > 0.09);
  }
  input["steps"] =
      parsed(R"([{"time": 1, "factors": {"jaw": 1, "a": 0}}, {"time": 2, "factors": {"a": 1, "jaw": 0.5}}])");
  const json later = solved(input);
  CHECK(force(later, "a", 1) == doctest::Approx(-0.5).epsilon(1.1e-5));
  CHECK(force(later, "b", 1) == doctest::Approx(-0.2).epsilon(1.1e-5));
  CHECK(force(later, "jaw", 0) == doctest::Approx(0.5).epsilon(1.1e-5));
}

TEST_CASE("what is no spring and no temperature is refused") {
  const auto with = [](const char* entry) {
    json input = bar("tet4", 0.3);
    add(input, entry);
    return refused(input);
  };
  const auto has = [](const std::string& text, const char* part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(with(R"({"on": "bottom", "spring": -1})"), "boundary[2].spring: expected a number > 0, got -1");
  has(with(R"({"on": "bottom", "spring": [0, 0, 0]})"),
      "boundary[2].spring: expected a stiffness > 0 in some direction, got [0,0,0]");
  has(with(R"({"on": "bottom", "node_spring": [0, -2, 0]})"),
      "boundary[2].node_spring[1]: expected a number ≥ 0, got -2");
  has(with(R"({"on": "bottom", "node_spring": 3})"),
      "boundary[2].node_spring: expected a list of 2 or 3 numbers");
  has(with(R"({"on": "bottom", "spring": 1, "pressure": 2})"), "boundary[2]");
  has(with(R"({"on": "all", "temperature": 20})"),
      "boundary[2].temperature: expected elements whose material has an expansion");
  has(with(R"({"on": "all", "temperature": "warm"})"),
      "boundary[2].temperature: expected a number, or an object with the key gradient or file, got \"warm\"");
  has(with(R"({"on": "nowhere", "spring": 1})"), "boundary[2].on");
  json input = bar("tet4", 0.3);
  input["material"][0]["expansion"] = "big";
  has(refused(input), "material[0].expansion: expected a number, got \"big\"");
  input = bar("tet4", 0.3);
  add(input, R"({"on": "bottom", "name": "bed", "spring": 5})");
  input["steps"] = parsed(R"([{"time": 1, "factors": {"bed": 1}}])");
  has(refused(input), "steps[0].factors[\"bed\"]: expected a load or a displacement, got a spring");
}
