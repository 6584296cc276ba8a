// SPDX-License-Identifier: BSD-3-Clause
// Temperature in plane stress: closed-form solutions, elastic and beyond yield, verified from the files.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "verified_run.hpp"

using namespace kacanov::testing;
using nlohmann::json;

namespace {

/// A strip fixed at its left end; α ΔT = 0.003, three times the yield strain. Each test adds a support at its
/// right end.
json warm_strip(const std::string& element, double poisson, const char* law) {
  json strip = parsed(R"({
    "mesh": {"box": {"size": [4, 1], "cells": [8, 3]}}, "plane": "stress", "thickness": 0.5,
    "material": [{"on": "all", "young": 200, "expansion": 1e-5}],
    "boundary": [{"on": "left", "name": "end", "displacement": [0, null]},
                 {"on": {"box": [[0, 0], [4, 0]]}, "displacement": [null, 0]},
                 {"on": "all", "name": "warmth", "temperature": 300}],
    "probe": [[4, 1]], "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  strip["mesh"]["box"]["element"] = element;
  strip["material"][0].update(parsed(law));
  strip["material"][0]["poisson"] = poisson;
  return strip;
}

constexpr const char *elastic = "{}", *bilinear = R"({"yield_stress": 0.2, "tangent_modulus": 20})",
                     *steep = R"({"plastic": [[0.2, 0], [0.3, 0.001], [0.32, 0.01]]})",
                     *rounded = R"({"law": {"type": "ramberg_osgood", "sigma0": 0.2, "alpha": 0.5, "n": 8}})";

/// Returns the tensile stress at this strain.
double in_tension(const std::string& law, double strain) {
  if (law == bilinear) return 0.2 + 20 * (strain - 0.001);
  if (law == steep) {  // between the second row, at 0.3/200 + 0.001, and the third
    const double from = 0.3 / 200 + 0.001, to = 0.32 / 200 + 0.01;
    return 0.3 + 0.02 * (strain - from) / (to - from);
  }
  if (law == elastic) return 200 * strain;
  double stress = 0.2;
  for (int step = 0; step < 100; ++step) {
    const double over = std::pow(stress / 0.2, 8);
    stress -= (stress / 200 + 0.5 * 0.001 * over - strain) / (1.0 / 200 + 4 * 0.001 * over / stress);
  }
  return stress;
}

double value(const json& number) { return number.get<double>(); }

}  // namespace

TEST_CASE("plane stress: a warm plate that nothing holds gets longer without stress, however strong it is") {
  const Workplace place;
  for (const char* element : {"tri3", "quad4"})
    for (const char* law : {elastic, bilinear}) {
      CAPTURE(element);
      CAPTURE(law);
      const json free = warm_strip(element, 0.3, law);
      const json result = solved(place, free);
      CHECK(value(result["probe"][0][0]) == doctest::Approx(0.012).epsilon(1e-9));
      CHECK(value(result["probe"][0][1]) == doctest::Approx(0.003).epsilon(1e-9));
      CHECK(value(result["max_von_mises"]) < 1e-8);
      CHECK(value(result["max_strain"]["value"]) == doctest::Approx(0.003).epsilon(1e-8));
      CHECK(result["plastic_elements"] == 0);
    }
}

TEST_CASE(
    "plane stress: a strip held at both ends bears −σ(α ΔT) of the test in tension, by load steps too") {
  const Workplace place;
  for (const char* element : {"tri3", "quad4"})
    for (const char* law : {elastic, bilinear, steep, rounded}) {
      if (element[0] == 't' && law != bilinear) continue;
      const double poisson = law == bilinear ? 0.45 : 0.3, stress = in_tension(law, 0.003);
      CAPTURE(element);
      CAPTURE(law);
      json held = warm_strip(element, poisson, law);
      held["boundary"].push_back(parsed(R"({"on": "right", "name": "other", "displacement": [0, null]})"));
      for (const char* steps : {"{}", R"({"load_steps": 3})"}) {
        if (law == elastic && steps[1] != '}') continue;
        held["solver"].update(parsed(steps));
        const json result = solved(place, held, steps[1] == '}' ? "1" : "2");
        // On the end face of 1 × 0.5.
        CHECK(value(result["reaction"]["end"]["force"][0]) == doctest::Approx(0.5 * stress).epsilon(1e-6));
        CHECK(value(result["reaction"]["other"]["force"][0]) == doctest::Approx(-0.5 * stress).epsilon(1e-6));
        CHECK(value(result["max_von_mises"]) == doctest::Approx(stress).epsilon(1e-6));
        // The width grows by α ΔT and by the incompressible part beyond yield.
        const double across = 0.003 + 0.003 / 2 - (1 - 2 * poisson) / 2 * stress / 200;
        CHECK(value(result["probe"][0][1]) == doctest::Approx(across).epsilon(1e-6));
      }
    }
}

TEST_CASE("plane stress: warmth closes the gap before a wall and presses on, along load curves") {
  const Workplace place;
  for (const char* law : {elastic, bilinear}) {
    CAPTURE(law);
    json strip = warm_strip("quad4", 0.3, law);
    strip["contact"] = parsed(R"([{"on": "right", "name": "wall", "friction": {"coulomb": 0.0},
      "obstacle": {"plane": {"point": [4.004, 0], "normal": [-1, 0]}}}])");
    strip["steps"] =
        parsed(R"([{"time": 1, "factors": {"warmth": 0.2}}, {"time": 2, "factors": {"warmth": 1}}])");
    const json result = solved(place, strip, "2");
    CHECK(result["load_steps"][0]["active_nodes"] == 0);
    // The free elongation of 0.012 exceeds the gap by 0.008, a strain of 0.002.
    CHECK(value(result["contact"]["wall"]["force"][0]) ==
          doctest::Approx(-0.5 * in_tension(law, 0.002)).epsilon(1e-6));
    strip["steps"][1]["factors"]["warmth"] = 0.3;
    CHECK(value(solved(place, strip)["probe"][0][0]) == doctest::Approx(0.0036).epsilon(1e-8));
  }
}

TEST_CASE("plane stress: a plate whose temperature differs, and yields, as a thin one in 3D") {
  const Workplace place;
  json plate = warm_strip("quad4", 0.3, bilinear);
  plate["mesh"]["box"]["cells"] = {24, 6};
  plate["boundary"][0]["displacement"] = {0, 0};
  plate["boundary"][2]["temperature"] = parsed(R"({"gradient": [0, 400], "value": 50})");
  plate["solver"]["tolerance"] = 1e-7;
  plate["boundary"].erase(1);
  const json flat = solved(place, plate, "2");
  plate.erase("plane");
  plate.erase("thickness");
  plate["mesh"]["box"] = parsed(R"({"size": [4, 1, 0.02], "cells": [24, 6, 1], "element": "hex8"})");
  plate["boundary"][0]["displacement"] = {0, 0, nullptr};
  plate["boundary"][1]["temperature"]["gradient"] = {0, 400, 0};
  plate["boundary"].push_back(parsed(R"({"on": "bottom", "displacement": [null, null, 0]})"));
  plate["probe"] = parsed("[[4, 1, 0]]");
  const json thin = solved(place, plate, "2");
  CHECK(flat["plastic_elements"] > 0);
  for (const std::size_t c : {0, 1})
    CHECK(value(flat["probe"][0][c]) == doctest::Approx(value(thin["probe"][0][c])).epsilon(0.02));
}
