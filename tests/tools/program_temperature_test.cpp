// SPDX-License-Identifier: BSD-3-Clause
// Temperature fields: closed-form solutions, files of nodal values, bad input.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "verified_run.hpp"

using namespace kacanov::testing;
using nlohmann::json;

namespace {

constexpr double alpha = 1e-5, young = 200;

/// A quarter of a plate of 8 × 4 × 1 that can bend freely, with probes in two corners; boundary[3] is its
/// temperature.
json plate(const std::string& element, double poisson) {
  json plate = parsed(R"({
    "mesh": {"box": {"size": [4, 2, 1], "cells": [4, 2, 2]}},
    "material": [{"on": "all", "young": 200, "expansion": 1e-5}],
    "boundary": [{"on": "left", "displacement": [0, null, null]}, {"on": "front", "displacement": [null, 0, null]},
                 {"on": {"box": [[0, 0, 0], [1, 1, 0]]}, "node_spring": [0, 0, 1e-6]}],
    "probe": [[4, 2, 1], [0, 0, 0]], "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  plate["mesh"]["box"]["element"] = element;
  plate["material"][0]["poisson"] = poisson;
  return plate;
}

/// Returns the temperature file of a box: node numbers in rows along x, then y, then z, as in make_box().
std::string lines_of_box(const std::array<int, 3>& cells, const std::array<double, 3>& size,
                         double (*rise)(double, double, double)) {
  std::string text = "# node, temperature\n";
  int node = 0;
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        text += std::to_string(++node) + ", " +
                std::to_string(rise(size[0] * i / cells[0], size[1] * j / cells[1], size[2] * k / cells[2])) +
                "\n";
  return text;
}

double number(const json& value) { return value.get<double>(); }

std::string refused(const Workplace& place, const json& input) {
  place.put_json("case.json", input);
  const Outcome outcome = place.run("check case.json");
  CHECK(outcome.exit_code == 2);
  return outcome.error;
}

void has(const std::string& text, const char* part) {
  CAPTURE(text);
  CHECK(text.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("warmth that grows over the thickness bends a plate without stress, exactly with tet10") {
  const double rise = 100, curvature = alpha * rise;  // for thickness 1
  for (const char* ranks : {"1", "3"}) {
    json input = plate("tet10", 0.3);
    input["solver"]["tolerance"] = 1e-8;
    input["boundary"].push_back(
        parsed(R"({"on": "all", "temperature": {"gradient": [0, 0, 100], "point": [0, 0, 0.5]}})"));
    const json result = solved(Workplace(), input, ranks);
    CHECK(number(result["max_von_mises"]) < 1e-7 * young * alpha * rise);
    CHECK(number(result["max_von_mises_nodal"]) < 1e-7 * young * alpha * rise);
    // u_x = κ x (z − h/2), u_y likewise, u_z = −κ (x² + y² − (z − h/2)²)/2.
    const std::array<double, 3> bent{curvature * 4 * 0.5, curvature * 2 * 0.5, -curvature * (16 + 4) / 2};
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(number(result["probe"][0][c]) - number(result["probe"][1][c]) ==
            doctest::Approx(bent[c]).epsilon(1e-6));
  }
}

TEST_CASE("between walls warmth presses by E α ΔT/(1 − 2ν), by its mean where it differs") {
  const double pressure = young * alpha * 100 / (1 - 2 * 0.25);
  const auto walled = [](const char* element, const char* temperature) {
    json input = plate(element, 0.25);
    input["boundary"] = json::array();
    for (const char* side : {"left", "right", "front", "back", "bottom", "top"})
      input["boundary"].push_back({{"on", side}, {"name", side}, {"normal", 0}});
    input["boundary"].push_back({{"on", "all"}, {"temperature", parsed(temperature)}});
    return solved(Workplace(), input);
  };
  for (const char* element : {"tet4", "tet10", "hex8"}) {
    CAPTURE(element);
    const json even = walled(element, "100");
    CHECK(number(even["reaction"]["top"]["force"][2]) == doctest::Approx(-8 * pressure).epsilon(1e-7));
    CHECK(number(even["reaction"]["right"]["force"][0]) == doctest::Approx(-2 * pressure).epsilon(1e-7));
    CHECK(walled(element, R"({"gradient": [0, 0, 0], "value": 100})")["reaction"] == even["reaction"]);
    if (element == std::string("tet4")) continue;  // cannot represent a strain that depends on z alone
    const json rising = walled(element, R"({"gradient": [0, 0, 100], "value": 50})");
    CHECK(number(rising["reaction"]["top"]["force"][2]) == doctest::Approx(-8 * pressure).epsilon(1e-7));
    CHECK(number(rising["reaction"]["right"]["force"][0]) == doctest::Approx(-2 * pressure).epsilon(1e-7));
  }
}

TEST_CASE("a file of nodes says what a linear field does, on any ranks, in steps") {
  for (const char* element : {"tet4", "tet10", "hex8"})
    for (const char* ranks : {"1", "2"}) {
      CAPTURE(element);
      const Workplace place;
      json input = plate(element, 0.3);
      input["boundary"].push_back(parsed(
          R"({"on": "all", "name": "warmth", "temperature": {"gradient": [3, -7, 100], "value": 20}})"));
      input["boundary"].push_back(parsed(R"({"on": "right", "name": "end", "displacement": [0, 0, 0]})"));
      input["steps"] =
          parsed(R"([{"time": 1, "factors": {"warmth": 2}}, {"time": 2, "factors": {"warmth": 0.5}}])");
      const json field = solved(place, input, ranks);
      const int halves = element == std::string("tet10") ? 2 : 1;  // rows include mid-side nodes
      place.put("warm.csv",
                lines_of_box({4 * halves, 2 * halves, 2 * halves}, {4, 2, 1},
                             [](double x, double y, double z) { return 20 + 3 * x - 7 * y + 100 * z; }));
      input["boundary"][3]["temperature"] = {{"file", "warm.csv"}};
      const json file = solved(place, input, ranks);
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(number(file["reaction"]["end"]["moment"][c]) ==
              doctest::Approx(number(field["reaction"]["end"]["moment"][c])).epsilon(1e-6));
      CHECK(number(file["max_von_mises"]) == doctest::Approx(number(field["max_von_mises"])).epsilon(1e-6));
      CHECK(number(file["max_von_mises_nodal"]) ==
            doctest::Approx(number(field["max_von_mises_nodal"])).epsilon(1e-6));
    }
}

TEST_CASE("a mesh of a file may be refined, raised and adapted: its nodes' temperatures go along") {
  const Workplace place;
  json input = plate("tet4", 0.3);
  input["mesh"] = {{"file", "plate.msh"}};
  place.put(
      "plate.inp",
      "*NODE\n1,0,0,0\n2,4,0,0\n3,0,2,0\n4,4,2,0\n5,0,0,1\n6,4,0,1\n7,0,2,1\n8,4,2,1\n"
      "*ELEMENT, TYPE=C3D4, ELSET=Plate\n1,1,2,4,8\n2,1,2,8,6\n3,1,6,8,5\n4,1,4,3,8\n5,1,3,7,8\n6,1,7,5,8\n"
      "*NSET, NSET=Lower\n1,2,3,4\n*NSET, NSET=Upper\n5,6,7,8\n");
  REQUIRE(place.run("convert plate.inp plate.msh").exit_code == 0);
  place.put("warm.csv", "Lower; -50\n** the other side\nUpper\t50\n");
  input["boundary"] = parsed(R"([{"on": "all", "node_spring": [1e-6, 1e-6, 1e-6]},
                                 {"on": "all", "temperature": {"file": "warm.csv"}}])");
  for (const char* finer : {R"({"refine": 1, "order": 2})", R"({"refine": 2, "order": 2})",
                            R"({"order": 2, "adapt": {"error": 0.001, "most_meshes": 2}})"}) {
    CAPTURE(finer);
    json mesh = input["mesh"];
    mesh.update(parsed(finer));
    place.put_json("case.json", input);
    const Outcome run = place.run("run case.json --output out --set 'mesh=" + mesh.dump() + "'");
    INFO(run.error);
    REQUIRE(run.exit_code == 0);
    CHECK(number(place.json("out/result.json")["max_von_mises"]) < 1e-5 * young * alpha * 100);
  }
}

TEST_CASE("a strip of two metals bends as Timoshenko's does") {
  // Plane strain: replace α by (1 + ν) α and E by E/(1 − ν²). Equal thickness, stiffness: κ = 3 Δα ΔT/(2 h).
  const json input = parsed(R"({
    "mesh": {"box": {"size": [20, 1], "cells": [160, 16], "element": "quad4"}},
    "material": [{"on": {"box": [[0, 0], [20, 0.5]]}, "young": 200, "poisson": 0.25, "expansion": 1e-5, "bbar": true},
                 {"on": {"box": [[0, 0.5], [20, 1]]}, "young": 200, "poisson": 0.25, "expansion": 3e-5, "bbar": true}],
    "boundary": [{"on": "left", "displacement": [0, null]}, {"on": {"box": [[0, 0], [0, 0.0625]]}, "displacement": [0, 0]},
                 {"on": "all", "temperature": {"gradient": [0, 0], "value": 100}}],
    "probe": [[20, 0.5]], "solver": {"tolerance": 1e-8}, "output": {"report": false}})");
  const json result = solved(Workplace(), input);
  const double curvature = 1.5 * 1.25 * 2e-5 * 100;
  CHECK(number(result["probe"][0][1]) == doctest::Approx(-curvature * 400 / 2).epsilon(0.01));
}

TEST_CASE("round an axis: a cylinder that is warmer within has Lamé's thermal stresses") {
  // ΔT = T (b − r)/(b − a), plane strain (Timoshenko, Goodier §135): u from ∫ T r dr.
  const double a = 1, b = 2, poisson = 0.3, rise = 100;
  json input = parsed(R"({
    "plane": "axisymmetric", "mesh": {"file": "ring.msh"},
    "material": [{"on": "all", "young": 200, "poisson": 0.3, "expansion": 1e-5, "bbar": false}],
    "boundary": [{"on": {"box": [[1, 0], [2, 0]]}, "name": "floor", "displacement": [null, 0]},
                 {"on": {"box": [[1, 0.1], [2, 0.1]]}, "displacement": [null, 0]},
                 {"on": "all", "temperature": {"gradient": [-100, 0], "point": [2, 0]}}],
    "probe": [[1, 0], [2, 0]], "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  const Workplace place;
  std::string deck = "*NODE\n";
  const int cells = 40;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i <= cells; ++i)
      deck += std::to_string(1 + i + k * (cells + 1)) + "," + std::to_string(a + (b - a) * i / cells) + "," +
              (k == 0 ? "0" : "0.1") + "\n";
  deck += "*ELEMENT, TYPE=CPE4, ELSET=Ring\n";
  for (int i = 1; i <= cells; ++i)
    deck += std::to_string(i) + "," + std::to_string(i) + "," + std::to_string(i + 1) + "," +
            std::to_string(i + cells + 2) + "," + std::to_string(i + cells + 1) + "\n";
  place.put("ring.inp", deck);
  REQUIRE(place.run("convert ring.inp ring.msh").exit_code == 0);
  const json result = solved(place, input);
  const auto moment = [&](double r) {  // ∫ₐʳ ΔT r dr
    const auto until = [&](double s) { return rise / (b - a) * (b * s * s / 2 - s * s * s / 3); };
    return until(r) - until(a);
  };
  const auto moved = [&](double r) {
    return (1 + poisson) / (1 - poisson) * alpha / r *
           (moment(r) + ((1 - 2 * poisson) * r * r + a * a) / (b * b - a * a) * moment(b));
  };
  CHECK(number(result["probe"][0][0]) == doctest::Approx(moved(a)).epsilon(1e-3));
  CHECK(number(result["probe"][1][0]) == doctest::Approx(moved(b)).epsilon(1e-3));
  // Along the axis ε_zz = 0: σ_z = Eα/(1 − ν) (2ν/(b² − a²) ∫ T r dr − T), integrated over the ring.
  const double force = -2 * 3.14159265358979 * young * alpha * moment(b);
  CHECK(number(result["reaction"]["floor"]["force"][1]) == doctest::Approx(-force).epsilon(1e-3));
}

TEST_CASE("what is no field of temperatures is refused with its place") {
  const Workplace place;
  json input = plate("hex8", 0.3);
  const auto with = [&](const char* temperature) {
    input["boundary"][3] = {{"on", "all"}, {"temperature", parsed(temperature)}};
    return refused(place, input);
  };
  const auto with_file = [&](const char* lines) {
    place.put("warm.csv", lines);
    return with(R"({"file": "warm.csv"})");
  };
  has(with(R"({"gradient": 3})"), "boundary[3].temperature.gradient: expected a list of 2 or 3 numbers");
  has(with(R"({"gradient": [1, 0]})"), "boundary[3].temperature.gradient: expected 3 entries");
  has(with(R"({"value": 3})"), "boundary[3].temperature");
  has(with(R"({"file": "a.csv", "gradient": [0, 0, 1]})"), "boundary[3].temperature");
  has(with(R"({"file": "none.csv"})"), "boundary[3].temperature.file: ");
  has(with_file("1, hot\n"), "warm.csv:1: expected a number, got \"hot\"");
  has(with_file("# all\n17\n"), "warm.csv:2: expected a node or a group and its value, got \"17\"");
  has(with_file("nowhere, 3\n"),
      "warm.csv:1: expected the number of a node or the name of a group of the mesh");
  has(with_file("# nothing\n"), "expected lines of a node or a group and its value, got none");
  has(with_file("top, 3\nbottom, 1\n"),
      "boundary[3].temperature: there is no value for node 16, a corner of elements that the entry selects");
  place.put("warm.csv", "top, 3\n1000, 1\n2000, 1\n");
  input["boundary"][3] = parsed(R"({"on": "all", "temperature": {"file": "warm.csv", "otherwise": 0}})");
  place.put_json("case.json", input);
  const Outcome checked = place.run("check case.json");
  CHECK(checked.exit_code == 0);
  has(checked.error,
      "warm.csv: 2 lines are of nodes that are in no element of the mesh; the first is line 2");
}
