// SPDX-License-Identifier: BSD-3-Clause
// Hosts that write numbers with a decimal comma: input and output must not depend on the locale.
#include <doctest/doctest.h>
#include <kacanov/kacanov_solve.h>

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// Everything that a solve returns to its host, except times and machine data.
struct Told {
  int code = -1;
  std::string message;
  nlohmann::json result;
  std::vector<double> displacement, stress, steps;
  bool operator==(const Told&) const = default;
};

void note(void* told, const kacanov_progress* step) {
  auto& steps = static_cast<Told*>(told)->steps;
  steps.insert(steps.end(), {step->worst_residual, step->energy, step->penalty});
}

Told told(const std::string& text, const std::string& folder) {
  Told out;
  kacanov_solve_options options{};
  options.struct_size = sizeof options;
  options.folder = folder.c_str();
  options.threads = 1;
  options.progress = &note;
  options.data = &out;
  char message[1024] = "";
  kacanov_solution* solution = nullptr;
  out.code = kacanov_solve(text.c_str(), &options, &solution, message, sizeof message);
  out.message = message;
  if (solution == nullptr) return out;
  const std::unique_ptr<kacanov_solution, void (*)(kacanov_solution*)> owner(solution,
                                                                             kacanov_solution_destroy);
  out.result = parsed(kacanov_solution_json(solution));
  for (const char* passing : {"seconds", "peak_memory_bytes", "phases"}) out.result.erase(passing);
  const auto all = [&](kacanov_field which) {
    std::size_t count = 0;
    const double* data = kacanov_solution_field(solution, which, &count);
    return std::vector<double>(data, data + count);
  };
  out.displacement = all(KACANOV_FIELD_DISPLACEMENT);
  out.stress = all(KACANOV_FIELD_STRESS);
  return out;
}

/// With this facet streams in the global locale print 1234567.5 as "1.234.567,5".
class Commas : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// Sets the global locale of C++, and that of C if `name` is one, until the end of the scope.
class HostLocale {
 public:
  explicit HostLocale(const char* name)
      : c_(std::setlocale(LC_ALL, nullptr)),
        cpp_(std::locale::global(std::locale(std::locale::classic(), new Commas))) {
    if (name != nullptr) std::setlocale(LC_ALL, name);
  }
  ~HostLocale() {
    std::locale::global(cpp_);
    std::setlocale(LC_ALL, c_.c_str());
  }
  HostLocale(const HostLocale&) = delete;
  HostLocale& operator=(const HostLocale&) = delete;

 private:
  std::string c_;
  std::locale cpp_;
};

/// Returns whether the C library has a German locale: an installed one, or one made in `place`.
bool has_german(const Workplace& place) {
  const auto found = [] {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    const bool set = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    const bool comma = set && std::string(std::localeconv()->decimal_point) == ",";
    std::setlocale(LC_ALL, before.c_str());
    return comma;
  };
  if (found()) return true;
  const std::string made = place.path("de_DE.UTF-8").string();
  if (std::system(("localedef -i de_DE -f UTF-8 '" + made + "' >/dev/null 2>&1").c_str()) != 0) return false;
  setenv("LOCPATH", made.substr(0, made.rfind('/')).c_str(), 1);
  return found();
}

struct Sample {
  const char* what;
  nlohmann::json input;
  const char* part;  ///< expected part of the error message, or of the result without an error; may be empty
};

nlohmann::json block() {
  return parsed(R"({
    "mesh": {"box": {"size": [2, 1, 1], "cells": [4, 2, 2], "element": "hex8"}},
    "material": [{"on": "all", "young": 1250.5, "poisson": 0.3}],
    "boundary": [{"on": "top", "displacement": [0, 0, -0.015]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
                 "friction": {"coulomb": 0.25}}],
    "probe": [[1.25, 0.5, 0.75]]
  })");
}

nlohmann::json from_file(const char* name) {
  return parsed(std::string(R"({
    "mesh": {"file": ")") +
                name + R"("},
    "material": [{"on": "all", "young": 1.5, "poisson": 0.25}],
    "boundary": [{"on": {"box": [[0, 0, 0], [0, 1.5, 1.5]]}, "displacement": [0, 0, 0]},
                 {"on": {"box": [[1.5, 0, 0], [1.5, 1.5, 1.5]]}, "traction": [0.125, 0, 0.0625]}],
    "probe": [[1.5, 1.5, 0.75]]
  })");
}

template <class Change>
nlohmann::json changed(nlohmann::json input, const Change& change) {
  change(input);
  return input;
}

void put_files(const Workplace& place) {
  std::string nodes, deck = "*NODE\n", temperatures;
  int tag = 1230;
  for (const char* z : {"0.0", "1.5"})
    for (const char* xy : {"0.0 1.5e-400", "1.5 0.0", "1.5 1.5", "0.0 1.5"}) {
      const std::string at = xy, number = std::to_string(++tag);
      nodes += number + " " + at + " " + z + "\n";
      const std::string x = at.substr(0, at.find(' ')), y = at.substr(at.find(' ') + 1);
      deck += number + ", " + x + ", " + (y == "1.5e-400" ? "0.0" : y) + ", " + z + "\n";
      temperatures += number + ", " + x + "\n";
    }
  place.put("cube.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n" + nodes +
                            "$EndNodes\n$Elements\n1\n1001 5 2 1 1 1231 1232 1233 1234 1235 1236 1237 1238\n"
                            "$EndElements\n");
  place.put("cube.inp", deck + "*ELEMENT, TYPE=C3D8\n1001, 1231, 1232, 1233, 1234, 1235, 1236, 1237, 1238\n");
  place.put("warm.csv", temperatures);
  place.put("floor.csv", "0.0, -0.0025, 0\n0.0125; 0.5e-3, 0\n");
  place.put("floor.stl",
            "solid floor\nfacet normal 0 0 1\nouter loop\nvertex -5.5 -5.5 0.0005\nvertex 9.5 -5.5 0.0005\n"
            "vertex -5.5 9.5 0.0025\nendloop\nendfacet\nendsolid floor\n");
}

std::vector<Sample> samples() {
  using Json = nlohmann::json;
  const auto on = [](const char* obstacle) {
    return changed(block(), [&](Json& input) { input["contact"][0]["obstacle"] = parsed(obstacle); });
  };
  const auto law = [](const char* text) {
    return changed(small_beam(), [&](Json& input) { input["material"][0]["law"] = parsed(text); });
  };
  return {
      {"a box, friction", block(), "converged"},
      {"a law", small_beam(), "converged"},
      {"a table", law(R"({"type": "table", "points": [[0, 0], [0.0125, 0.0125], [0.5, 0.25]]})"),
       "starts with the slope"},
      {"one step", changed(block(), [](Json& input) { input["solver"]["max_outer"] = 1; }), "not_converged"},
      {"load steps", changed(block(), [](Json& input) { input["solver"]["load_steps"] = 3; }), "converged"},
      {"Gmsh", from_file("cube.msh"), "converged"},
      {"Abaqus", from_file("cube.inp"), "converged"},
      {"STL", on(R"({"surface": {"file": "floor.stl"}})"), "converged"},
      {"heights", on(R"({"height_map": {"file": "floor.csv", "lower": [-0.5, -0.5], "upper": [2.5, 1.5]}})"),
       "converged"},
      {"temperatures",
       changed(from_file("cube.msh"),
               [](Json& input) {
                 input["material"][0]["expansion"] = 1.25e-3;
                 input["boundary"].push_back(parsed(R"({"on": "all", "temperature": {"file": "warm.csv"}})"));
               }),
       "converged"},
      {"a probe outside",
       changed(block(),
               [](Json& input) {
                 input["mesh"]["box"]["cells"] = {20, 10, 10};
                 input["probe"] = {{1.5, 0.5, 1.25}};
               }),
       "the nearest node"},
      {"two displacements",
       changed(block(),
               [](Json& input) {
                 input["boundary"].push_back(parsed(R"({"on": "left", "displacement": [1234.5, 0, 0]})"));
               }),
       "= 1234.5 here"},
      {"units", changed(block(), [](Json& input) { input["material"][0]["young"] = 1.25e60; }),
       "1.04167e+60"},
      {"a slope too steep",
       changed(block(),
               [](Json& input) {
                 input["boundary"] = parsed(R"([{"on": "top", "traction": [-0.5, 0, -1.25]}])");
               }),
       "a friction coefficient of 0.4"},
      {"a value", changed(block(), [](Json& input) { input["material"][0]["poisson"] = 0.5625; }), "0.5625"}};
}

void compare(const Workplace& place, const char* locale) {
  put_files(place);
  const std::string folder = place.path(".").string();
  for (const Sample& sample : samples()) {
    INFO(sample.what);
    const std::string text = sample.input.dump();
    const Told plain = told(text, folder);
    const std::string said = plain.code == KACANOV_OK ? plain.result.dump() : plain.message;
    INFO(said);
    CHECK(said.find(sample.part) != std::string::npos);
    const Told there = [&] {
      const HostLocale host(locale);
      return told(text, folder);
    }();
    CHECK(there.code == plain.code);
    CHECK(there.message == plain.message);
    CHECK(there.result == plain.result);
    CHECK(there == plain);
  }
}

}  // namespace

TEST_CASE("the global locale of a host in C++ has commas and groups") { compare(Workplace(), nullptr); }

TEST_CASE("the locale of a host in C and C++ has commas and groups") {
  const Workplace place;
  if (!has_german(place)) {
    MESSAGE("skipped: there is no de_DE.UTF-8, and localedef makes none");
    return;
  }
  compare(place, "de_DE.UTF-8");
}

TEST_CASE("the operator alone says what is wrong with a point") {
  const Workplace place;
  const char* german = has_german(place) ? "de_DE.UTF-8" : nullptr;
  const double points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::int32_t cells[] = {0, 1, 2, 3};
  const auto message = [&](double bulk, double x0) {
    kacanov_law law{};
    law.struct_size = sizeof law;
    law.kind = KACANOV_LOGARITHMIC;
    law.bulk = bulk;
    law.shear = 1.5;
    law.x0 = x0;
    kacanov_description body{};
    body.struct_size = sizeof body;
    body.threads = 1;
    body.element = KACANOV_TET4;
    body.nodes = 4;
    body.coordinates = points;
    body.elements = 1;
    body.connectivity = cells;
    body.laws = 1;
    body.law = &law;
    char text[512] = "";
    kacanov_operator* op = nullptr;
    CHECK(kacanov_create(&body, &op, text, sizeof text) != KACANOV_OK);
    return std::string(text);
  };
  for (const auto& [bulk, x0] : {std::pair{-1234.5, 0.5}, {1.5, -0.125}}) {
    const std::string plain = message(bulk, x0);
    const HostLocale host(german);
    CHECK(message(bulk, x0) == plain);
  }
}
