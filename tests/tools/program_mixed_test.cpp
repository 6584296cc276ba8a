// SPDX-License-Identifier: BSD-3-Clause
// Tetrahedra with dilatation averaged at corners or over patches, verified by an independent assembly, on any
// number of ranks.
#include <doctest/doctest.h>

#include <string>

#include "verified_run.hpp"

using namespace kacanov::testing;
using nlohmann::json;

namespace {

/// A block of three materials, two of them mixed with different bulk moduli, pressed on a plane.
json block(const char* element) {
  json input = json::parse(R"({
    "mesh": {"box": {"size": [2, 1, 1], "cells": [6, 3, 3]}},
    "material": [
      {"on": "all", "young": 1, "poisson": 0.3, "law": {"type": "logarithmic", "x0": 0.005}, "formulation": "mixed"},
      {"on": {"box": [[0, 0, 0.66], [2, 1, 1]]}, "young": 3, "poisson": 0.45, "formulation": "mixed",
       "law": {"type": "linear_hardening", "x0": 0.01, "gamma": 0.01}},
      {"on": {"box": [[0, 0, 0], [0.67, 1, 0.34]]}, "young": 2, "poisson": 0.2}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]},
                 {"on": "top", "traction": [0, 0.01, -0.06]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
                 "friction": {"coulomb": 0.2}}],
    "solver": {"tolerance": 1e-8},
    "probe": [[2, 0.5, 1]]
  })");
  input["mesh"]["box"]["element"] = element;
  return input;
}

}  // namespace

TEST_CASE("mixed tetrahedra: verified, and the same on one rank, two and three") {
  const char* element = "tet10";
  SUBCASE("tet10") {}
  SUBCASE("tet4") { element = "tet4"; }
  const Workplace place;
  const json alone = solved(place, block(element), "1");
  CHECK(alone["plastic_elements"] > 0);
  for (const char* ranks : {"2", "3"}) {
    const json several = solved(place, block(element), ranks);
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(several["probe"][0][c].get<double>() ==
            doctest::Approx(alone["probe"][0][c].get<double>()).epsilon(1e-6));
    CHECK(several["max_von_mises"].get<double>() ==
          doctest::Approx(alone["max_von_mises"].get<double>()).epsilon(1e-6));
    CHECK(several["discretisation"]["energy"].get<double>() ==
          doctest::Approx(alone["discretisation"]["energy"].get<double>()).epsilon(1e-4));
  }
}

TEST_CASE("mixed tetrahedra: a coarser start, a temperature and load steps") {
  const char* element = "tet10";
  SUBCASE("tet10") {}
  SUBCASE("tet4") { element = "tet4"; }
  const Workplace place;
  json input = block(element);
  input["mesh"] = {{"box", {{"size", {2, 1, 1}}, {"cells", {3, 2, 2}}, {"element", element}}}, {"refine", 1}};
  input["material"] = json::array({input["material"][0]});
  input["material"][0]["expansion"] = 0.001;
  input["boundary"][1]["traction"] = {0, 0, -0.02};
  input["boundary"].push_back({{"on", "all"}, {"temperature", 5}});
  input["solver"]["load_steps"] = {0.5, 1.0};
  const json two = solved(place, input, "2");
  const json one = solved(place, input, "1");
  CHECK(two["probe"][0][2].get<double>() == doctest::Approx(one["probe"][0][2].get<double>()).epsilon(1e-6));
}

TEST_CASE("mixed, by word, is B-bar in hexahedra") {
  const Workplace place;
  json input = block("hex8");
  const json mixed = solved(place, input, "1");
  for (json& material : input["material"]) {
    const bool was = material.contains("formulation");
    material.erase("formulation");
    material["bbar"] = was;
  }
  CHECK(solved(place, input, "1")["probe"] == mixed["probe"]);
}
