// SPDX-License-Identifier: BSD-3-Clause
// The obstacle `box` rotated together with the body, in 3D and 2D, verified from the files; invalid frames.
#include <doctest/doctest.h>

#include <functional>
#include <string>

#include "turned_body.hpp"
#include "verified_run.hpp"

using namespace kacanov;
using namespace kacanov::testing;
using nlohmann::json;

namespace {

using Turn = std::function<Point(const Point&)>;

/// Returns the first `dim` entries as JSON.
json entries(const Point& x, std::size_t dim) {
  json all = json::array();
  for (std::size_t c = 0; c < dim; ++c) all.push_back(x[c]);
  return all;
}

json frame_of(const Turn& turn, std::size_t dim) {
  json axes = json::array();
  for (std::size_t a = 0; a < dim; ++a) {
    Point axis{};
    axis[a] = 1.0 + static_cast<double>(a);  // arbitrary length
    axes.push_back(entries(turn(axis), dim));
  }
  return axes;
}

/// A body pressed down on a punch off its centre: contact with a face and beyond its edges.
json on_punch(const Turn& turn, std::size_t dim, bool with_frame) {
  json input = parsed(R"({
    "mesh": {"file": "body.msh"}, "material": [{"on": "all", "young": 200, "poisson": 0.3}],
    "boundary": [{"on": "top"}],
    "contact": [{"on": "bottom", "name": "punch", "obstacle": {"box": {}}, "friction": {"coulomb": 0.2}}],
    "solver": {"tolerance": 1e-9}, "output": {"report": false}})");
  Point down{0.002, 0, 0}, lower{0.3, 0.2, -1}, upper{1.4, 0.9, -0.001};
  down[dim - 1] = -0.01;
  if (dim == 2) {
    lower = {0.3, -1, 0};
    upper = {1.4, -0.001, 0};
  }
  input["boundary"][0]["displacement"] = entries(turn(down), dim);
  json& box = input["contact"][0]["obstacle"]["box"];
  box["lower"] = entries(turn(lower), dim);
  box["upper"] = entries(turn(upper), dim);
  if (with_frame) box["frame"] = frame_of(turn, dim);
  return input;
}

}  // namespace

TEST_CASE("a box that is turned with the body presses as it did along the axes") {
  const Workplace place;
  const Turn stay = [](const Point& x) { return x; };
  const std::array<BoxSpec, 2> boxes{BoxSpec{{2, 1, 0.5}, {8, 4, 2}, ElementType::hex8},
                                     BoxSpec{{2, 1, 0}, {16, 8, 0}, ElementType::tri3}};
  for (const BoxSpec& box : boxes) {
    const std::size_t dim = dimension(box.type);
    const Turn turn = dim == 3 ? Turn(turned) : Turn(turned_in_plane);
    put_mesh(place, box, stay);
    const json straight = solved(place, on_punch(stay, dim, false));
    const json framed = solved(place, on_punch(stay, dim, true));
    put_mesh(place, box, turn);
    const json slanting = solved(place, on_punch(turn, dim, true), "2");
    for (const char* part : {"force", "friction_force"}) {
      CAPTURE(part);
      const Point wanted = point_of(straight["contact"]["punch"][part]);
      CHECK(wanted[dim - 1] > (std::string(part) == "force" ? 0.1 : -1.0));
      CHECK(distance(point_of(framed["contact"]["punch"][part]), wanted) < 1e-9);
      CHECK(distance(point_of(slanting["contact"]["punch"][part]), turn(wanted)) < 1e-7);
    }
    CHECK(slanting["active_nodes"] == straight["active_nodes"]);
    CHECK(straight["active_nodes"] < straight["contact_nodes"]);
  }
}

TEST_CASE("what is wrong with a box's frame is said by its key") {
  const Workplace place;
  json input = parsed(R"({
    "mesh": {"box": {"size": [1, 1, 1], "cells": [2, 2, 2], "element": "hex8"}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3}],
    "boundary": [{"on": "top", "displacement": [0, 0, -0.01]}],
    "contact": [{"on": "bottom", "obstacle": {"box": {"lower": [0, 0, -2], "upper": [1, 1, 0]}}}]})");
  const auto refused = [&](const char* frame, const std::string& message) {
    input["contact"][0]["obstacle"]["box"]["frame"] = parsed(frame);
    place.put_json("case.json", input);
    const Outcome outcome = place.run("check case.json");
    INFO(outcome.error);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find("contact[0].obstacle.box" + message) != std::string::npos);
  };
  refused("[[1, 0, 0]]", ".frame: expected a list of 2 or 3 axes");
  refused("[[1, 0], [0, 1]]", ".frame[0]: expected 3 entries, as the mesh has 3 dimensions, got 2");
  refused("[[1, 0, 0], [1, 1, 0], [0, 0, 1]]",
          ".frame[1]: expected an axis orthogonal to those before, got [1,1,0]");
  refused("[[0, 0, 0], [0, 1, 0], [0, 0, 1]]", ".frame[0]: expected a vector that is not zero, got [0,0,0]");
  refused("[[1, 0, 0], [0, 0, 1], [0, -1, \"z\"]]", ".frame[2][2]: expected a number, got \"z\"");
  // Along the axis (-1, 1, 0) both corners have the same coordinate.
  refused("[[1, 1, 0], [-1, 1, 0], [0, 0, 1]]",
          ": expected a lower corner that is below the upper one in every direction of the frame, got "
          "[0,0,-2] and [1,1,0]");
}
