// SPDX-License-Identifier: BSD-3-Clause
// Obstacles in whole runs: every kind solved and verified from its files, surfaces and height maps against
// the shapes that they approximate, bad files.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <sstream>
#include <vector>

#include "png_writer.hpp"
#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

using Corner = std::array<double, 3>;
using Triangle = std::array<Corner, 3>;

/// A cap of the ball around (1, 0.5, −2) of radius 2 about its highest point, in rings, oriented outwards.
std::vector<Triangle> cap(int rings) {
  const auto at = [&](int ring, int part) {
    const double far = 0.9 * ring / rings, turn = 2 * M_PI * part / (6.0 * rings);
    return Corner{1 + 2 * std::sin(far) * std::cos(turn), 0.5 + 2 * std::sin(far) * std::sin(turn),
                  -2 + 2 * std::cos(far)};
  };
  std::vector<Triangle> triangles;
  for (int ring = 0; ring < rings; ++ring)
    for (int part = 0; part < 6 * rings; ++part) {
      const Corner a = at(ring, part), b = at(ring + 1, part), c = at(ring + 1, part + 1),
                   d = at(ring, part + 1);
      triangles.push_back({a, b, c});
      if (ring > 0) triangles.push_back({a, c, d});
    }
  return triangles;
}

std::string ascii_stl(const std::vector<Triangle>& triangles) {
  std::ostringstream text;
  text.precision(17);
  text << "solid ball\n";
  for (const Triangle& t : triangles) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (const Corner& x : t) text << "  vertex " << x[0] << " " << x[1] << " " << x[2] << "\n";
    text << " endloop\nendfacet\n";
  }
  text << "endsolid ball\n";
  return text.str();
}

std::string binary_stl(const std::vector<Triangle>& triangles) {
  std::string bytes = "solid only in name";
  bytes.resize(84, ' ');
  const auto count = static_cast<std::uint32_t>(triangles.size());
  std::memcpy(&bytes[80], &count, 4);
  for (const Triangle& t : triangles) {
    std::array<float, 12> numbers{};
    for (std::size_t k = 0; k < 9; ++k) numbers[3 + k] = static_cast<float>(t[k / 3][k % 3]);
    bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string gmsh_facets(const std::vector<Triangle>& triangles) {
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 3 \"tool\"\n2 4 "
          "\"other\"\n$EndPhysicalNames\n";
  text << "$Nodes\n" << 3 * triangles.size() + 3 << "\n";
  std::size_t n = 0;
  for (const Triangle& t : triangles)
    for (const Corner& x : t) text << ++n << " " << x[0] << " " << x[1] << " " << x[2] << "\n";
  // A facet of another group, in front of the surface.
  text << n + 1 << " 0 0 1\n" << n + 2 << " 2 0 1\n" << n + 3 << " 1 1 1\n";
  text << "$EndNodes\n$Elements\n" << triangles.size() + 1 << "\n";
  for (std::size_t t = 0; t < triangles.size(); ++t)
    text << t + 1 << " 2 2 3 1 " << 3 * t + 1 << " " << 3 * t + 2 << " " << 3 * t + 3 << "\n";
  text << triangles.size() + 1 << " 2 2 4 1 " << n + 1 << " " << n + 2 << " " << n + 3 << "\n$EndElements\n";
  return text.str();
}

/// A brick that is lowered by a hundredth onto the obstacle.
nlohmann::json brick(const std::string& obstacle) {
  nlohmann::json brick = parsed(R"({
    "mesh": {"box": {"size": [2, 1, 0.5], "cells": [12, 6, 3], "element": "hex8"}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3}],
    "boundary": [{"on": "top", "displacement": [0, 0, -0.01]}],
    "contact": [{"on": "bottom", "name": "tool", "obstacle": {}}],
    "output": {"report": false}})");
  brick["contact"][0]["obstacle"] = parsed(obstacle);
  return brick;
}

double force(const Workplace& place) {
  return place.json("out/result.json").at("contact").at("tool").at("force").at(2);
}

constexpr const char* ball = R"({"sphere": {"centre": [1, 0.5, -2], "radius": 2}})";

}  // namespace

TEST_CASE("every kind of obstacle: run on one rank or two, and verified") {
  const Workplace place;
  place.put("ball.stl", ascii_stl(cap(6)));
  place.put("ball.msh", gmsh_facets(cap(6)));
  place.put("heights.csv", "# x ->\n0.00, -0.01, 0\n0, 0.002, 0.001\n-1e-3; 0 +0.001\n");
  place.put("heights.pgm", "P2\n# two by three\n2 3\n10\n0 5\n10 10\n3 4\n");
  place.put("heights.png", png(2, 3, {0, 500, 999, 1000, 300, 400}, {0, 16, -1, 0}));
  place.put("heights.pbm", "P1\n3 2\n011\n1 0 0\n");
  const std::vector<const char*> obstacles{
      ball,
      R"({"sphere": {"centre": [1, 0.5, 2.1], "radius": 2.3, "inside": true}})",
      R"({"cylinder": {"point": [1, 7, -2], "axis": [0, 2, 0], "radius": 2}})",
      R"({"cylinder": {"point": [1, 7, -2], "axis": [0, 2, 0.1], "radius": 2.5, "direction": [0, 0, -1]}})",
      R"({"cone": {"apex": [1, 0.5, 0], "axis": [0, 0, -1], "half_angle": 85}})",
      R"({"cone": {"apex": [0.9, 0.5, 0], "axis": [0.1, 0, -1], "half_angle": 85, "direction": [0, 0, -1]}})",
      R"({"torus": {"centre": [1.01, 0.52, -0.2], "axis": [0, 0, 1], "radius": 0.4, "tube": 0.2}})",
      R"({"box": {"lower": [0.45, 0.2, -1], "upper": [1.55, 0.9, 0]}})",
      R"({"box": {"lower": [0.7, -0.3, -1], "upper": [1.5, 1.1, 0.002], "frame": [[1, 1, 0.1], [-1, 1, 0], [-0.1, -0.1, 2]]}})",
      R"({"surface": {"file": "ball.stl"}})",
      R"({"surface": {"file": "ball.msh", "group": "tool"}})",
      R"({"height_map": {"file": "heights.csv", "lower": [0, 0], "upper": [2, 1]}})",
      R"({"height_map": {"file": "heights.pgm", "lower": [-1, 0.1], "upper": [2, 1], "scale": 0.01, "offset": -0.002}})",
      R"({"height_map": {"file": "heights.png", "lower": [-1, 0.1], "upper": [2, 1], "scale": 0.6, "offset": -0.002}})",
      R"({"height_map": {"file": "heights.pbm", "lower": [0, 0], "upper": [2, 1], "scale": -0.004}})"};
  int ranks = 1;
  for (const char* obstacle : obstacles) {
    INFO(obstacle);
    place.put_json("brick.json", brick(obstacle));
    ranks = 3 - ranks;
    const Outcome run = place.run("run brick.json --output out --ranks " + std::to_string(ranks));
    INFO(run.error);
    REQUIRE(run.exit_code == 0);
    CHECK(force(place) > 0);
    const Outcome outcome = place.run("verify brick.json --output out");
    INFO(outcome.error, outcome.output);
    CHECK(outcome.exit_code == 0);
  }
}

TEST_CASE("adapted meshes follow obstacles from files") {
  const Workplace place;
  place.put("ball.stl", ascii_stl(cap(6)));
  place.put("heights.csv", "0.00, -0.01, 0\n0, 0.002, 0.001\n-1e-3; 0; 0.001\n");
  for (const char* obstacle :
       {R"({"surface": {"file": "ball.stl"}})",
        R"({"height_map": {"file": "heights.csv", "lower": [0, 0], "upper": [2, 1]}})"}) {
    INFO(obstacle);
    nlohmann::json adapted = brick(obstacle);
    adapted["mesh"]["box"]["element"] = "tet4";
    adapted["mesh"]["adapt"] = {{"error", 0.3}, {"most_meshes", 2}};
    place.put_json("brick.json", adapted);
    const Outcome run = place.run("run brick.json --output out");
    INFO(run.error);
    REQUIRE(run.exit_code == 0);
    CHECK(force(place) > 0);
  }
}

TEST_CASE(
    "obstacles that move and that are pushed: run on one rank and two, verified, honest about what is not "
    "there") {
  const Workplace place;
  nlohmann::json input = brick(R"({"cylinder": {"point": [1, 0, -2.001], "axis": [0, 1, 0], "radius": 2}})");
  input["boundary"][0]["displacement"] = {0, 0, 0};
  input["contact"][0]["friction"]["coulomb"] = 0.2;
  nlohmann::json pushed = input, moving = input;
  pushed["contact"][0]["force_controlled"] = parsed(R"({"force": 2.5, "direction": [0, 0, 3]})");
  moving["contact"][0]["motion"] = parsed(R"({"centre": [1, 0, -2], "path": [
    {"time": 0.5, "translation": [0, 0, 0.01]},
    {"time": 1, "translation": [0.001, 0, 0.01], "rotation": [0, 0.0005, 0]}]})");
  moving["solver"]["load_steps"] = 4;
  for (const auto& document : {pushed, moving})
    for (const char* ranks : {"1", "2"}) {
      place.put_json("brick.json", document);
      const Outcome run = place.run(std::string("run brick.json --output out --ranks ") + ranks);
      INFO(run.error, run.output);
      REQUIRE(run.exit_code == 0);
      const Outcome outcome = place.run("verify brick.json --output out");
      INFO(outcome.error, outcome.output);
      CHECK(outcome.exit_code == 0);
    }
  CHECK(place.json("out/result.json").at("load_steps").size() == 4);
  const std::string told = place.run("run brick.json --output out").output;
  CHECK(told.find("\nload step 4 of 4 (factor 1)\n") != std::string::npos);
  place.put_json("brick.json", pushed);
  const Outcome to_force = place.run("run brick.json --output out --set output.report=true");
  REQUIRE(to_force.exit_code == 0);
  CHECK(to_force.output.find("\ntool pushed by 0.0") != std::string::npos);
  // Outer steps are numbered consecutively over the load steps.
  const std::string history = contents(place.path("out/history.csv"));
  CHECK(count_lines(history) == 1 + place.json("out/result.json").at("outer_iterations").get<std::size_t>());
  CHECK(history.rfind("\n1,") == history.find("\n1,"));
  CHECK(force(place) == doctest::Approx(2.5).epsilon(1.1e-5));
  CHECK(place.json("out/result.json").at("contact").at("tool").at("travel") > 0.001);
  CHECK(place.run("verify brick.json --output out --set contact[0].force_controlled.force=2.501").exit_code ==
        1);
  CHECK(place.run("partition brick.json --ranks 2 --output parts").exit_code == 0);
  const Outcome from_parts = place.run("run brick.json --parts parts --output out");
  INFO(from_parts.error);
  CHECK(from_parts.exit_code == 0);
  CHECK(force(place) == doctest::Approx(2.5).epsilon(1.1e-5));

  // Stopped during a search for the travel, the run continues with the same numbers.
  CHECK(place.run("run brick.json --output whole").exit_code == 0);
  CHECK(place.run("run brick.json --output cut --set solver.max_outer=2").exit_code == 1);
  CHECK(place.run("run brick.json --output cut --restart").exit_code == 0);
  for (const char* key : {"contact_force", "outer_iterations", "cg_iterations", "contact", "load_steps"})
    CHECK(place.json("cut/result.json").at(key) == place.json("whole/result.json").at(key));
  const auto refused = [&](const std::string& change, const std::string& message) {
    const Outcome outcome = place.run("check brick.json " + change);
    INFO(outcome.error);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find(message) != std::string::npos);
  };
  refused("--set contact[0].force_controlled.force=-1",
          "contact[0].force_controlled.force: expected a number > 0");
  refused("--set contact[0].force_controlled.direction=[0,0,0]",
          "contact[0].force_controlled.direction: expected a vector that is not zero");
  refused("--set contact[0].motion.path=[]", "contact[0].motion.path: expected at least one place");
  refused(R"(--set 'contact[0].motion.path=[{"time":1}]')", "force_controlled: expected no motion beside it");
  refused(R"(--set 'contact[0].motion.path=[{"time":1},{"time":1}]')",
          "contact[0].motion.path[1].time: expected a time after 1, got 1");
  refused(R"(--set 'contact[0].obstacle={"gap":0}')",
          "contact[0].force_controlled: expected an obstacle that has a place, got a gap");
  place.put_json("brick.json", moving);
  refused(R"(--set 'steps=[{"time":1,"factors":{"tool":1}}]' --set solver={})",
          "steps[0].factors[\"tool\"]: expected no factor of an obstacle");
  REQUIRE(place.run("run brick.json --output out --set contact[0].relinearise=true").exit_code == 0);
  const Outcome anew = place.run("verify brick.json --output out --set contact[0].relinearise=true");
  INFO(anew.error, anew.output);
  CHECK(anew.exit_code == 0);
}

TEST_CASE("an edge in the plane of symmetry presses without a lateral force, and is verified") {
  const Workplace place;
  // A blade of two slopes that rise from the line x = 0.5, pressed 0.05 into the middle of the upper side.
  const std::vector<Triangle> blade{{{{0.5, -1, 0.95}, {0.2, 2, 1.05}, {0.5, 2, 0.95}}},
                                    {{{0.5, -1, 0.95}, {0.2, -1, 1.05}, {0.2, 2, 1.05}}},
                                    {{{0.5, -1, 0.95}, {0.5, 2, 0.95}, {0.8, 2, 1.05}}},
                                    {{{0.5, -1, 0.95}, {0.8, 2, 1.05}, {0.8, -1, 1.05}}}};
  place.put("blade.stl", ascii_stl(blade));
  place.put("binary.stl", binary_stl(blade));
  nlohmann::json input = parsed(R"({
    "mesh": {"box": {"size": [1, 1, 1], "cells": [4, 4, 4], "element": "hex8"}},
    "material": [{"on": "all", "young": 10, "poisson": 0.3}],
    "boundary": [{"on": "bottom", "displacement": [0, 0, 0]}],
    "contact": [{"on": "top", "name": "tool", "obstacle": {}}],
    "output": {"report": false}})");
  const auto pressed = [&](const std::string& obstacle) {
    input["contact"][0]["obstacle"] = parsed(obstacle);
    place.put_json("case.json", input);
    const Outcome run = place.run("run case.json --output out");
    CAPTURE(obstacle);
    REQUIRE(run.exit_code == 0);
    const Outcome verified = place.run("verify case.json --output out");
    INFO(verified.output);
    CHECK(verified.exit_code == 0);
    const nlohmann::json result = place.json("out/result.json");
    const nlohmann::json& force = result.at("contact").at("tool").at("force");
    CHECK(std::abs(force.at(0).get<double>()) < 1e-7 * std::abs(force.at(2).get<double>()));
    CHECK(force.at(2).get<double>() < -0.1);
    CHECK(result.at("warnings").dump().find("5 nodes are equally near to several faces of the obstacle") !=
          std::string::npos);
    return force.at(2).get<double>();
  };
  const double text = pressed(R"({"surface": {"file": "blade.stl"}})");
  CHECK(pressed(R"({"surface": {"file": "binary.stl"}})") == doctest::Approx(text).epsilon(1e-5));
  // A box standing on its edge, symmetric, fixed, or moved down from its first contact.
  const auto box = [](double low) {
    const std::string from = std::to_string(low), to = std::to_string(low + 2);
    return R"({"box": {"lower": [0.5, -1, )" + from + R"(], "upper": [0.5, 2, )" + to +
           R"(], "frame": [[1, 0, 1], [0, 1, 0], [-1, 0, 1]]}})";
  };
  const double at_rest = pressed(box(0.95));
  input["contact"][0]["motion"] = parsed(R"({"path": [{"time": 1, "translation": [0, 0, -0.05]}]})");
  CHECK(pressed(box(1.0)) == doctest::Approx(at_rest).epsilon(0.2));
}

TEST_CASE("a ball of triangles presses as a ball does, of second order in its facets, in every format") {
  const Workplace place;
  const auto pressed = [&](const std::string& obstacle) {
    place.put_json("brick.json", brick(obstacle));
    REQUIRE(place.run("run brick.json --output out").exit_code == 0);
    return force(place);
  };
  const double exact = pressed(ball);
  std::vector<double> off;
  for (const int rings : {6, 12, 24}) {
    place.put("ball.stl", ascii_stl(cap(rings)));
    off.push_back(std::abs(pressed(R"({"surface": {"file": "ball.stl"}})") / exact - 1));
  }
  CAPTURE(off[0]);
  CAPTURE(off[1]);
  CHECK(off[1] < 0.3 * off[0]);
  CHECK(off[2] < 0.6 * off[1]);
  CHECK(off[2] < 0.05);
  const double ascii = pressed(R"({"surface": {"file": "ball.stl"}})");
  place.put("ball.stl", binary_stl(cap(24)));
  CHECK(pressed(R"({"surface": {"file": "ball.stl"}})") == doctest::Approx(ascii).epsilon(1e-4));
  place.put("ball.msh", gmsh_facets(cap(24)));
  CHECK(pressed(R"({"surface": {"file": "ball.msh", "group": "tool"}})") ==
        doctest::Approx(ascii).epsilon(1e-12));
  // A height map of the ball, seen from below.
  std::ostringstream heights;
  heights.precision(17);
  for (int row = 100; row >= 0; --row) {
    for (int column = 0; column <= 200; ++column)
      heights << -2 + std::sqrt(4 - std::pow(0.01 * column - 1, 2) - std::pow(0.01 * row - 0.5, 2)) << ",";
    heights << "\n";
  }
  place.put("heights.csv", heights.str());
  const double upwards =
      pressed(R"({"sphere": {"centre": [1, 0.5, -2], "radius": 2, "direction": [0, 0, -1]}})");
  CHECK(pressed(R"({"height_map": {"file": "heights.csv", "lower": [0, 0], "upper": [2, 1]}})") ==
        doctest::Approx(upwards).epsilon(1e-3));
}

TEST_CASE("a bad file of an obstacle is refused by its key, name and line") {
  const Workplace place;
  place.put("words.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n");
  place.put("cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n");
  place.put("short.stl", binary_stl(cap(2)).substr(0, 200).replace(0, 5, "a bin"));
  place.put("flat.stl", ascii_stl({{Corner{0, 0, 0}, Corner{1, 0, 0}, Corner{2, 0, 0}}}));
  place.put("ball.msh", gmsh_facets(cap(2)));
  place.put("ragged.csv", "1,2,3\n4,5\n");
  place.put("words.csv", "1,2\n3,four\n");
  place.put("line.csv", "1,2,3\n");
  place.put("short.pgm", "P5\n4 4\n255\nabc");
  place.put("large.pgm", "P2\n2 2\n3\n1 2 3 4\n");
  place.put("huge.pgm", "P5\n65536 65536\n255\n");
  place.put("picture.png", "\x89PNG\r\n");
  struct Row {
    const char *kind, *file, *message;
  };
  const std::vector<Row> rows{
      {"surface", "none.stl", "none.stl: cannot be opened: No such file"},
      {"surface", "words.stl", "words.stl:4: expected a number, got \"zero\""},
      {"surface", "cut.stl", "cut.stl:4: expected \"vertex\" and three numbers, got the end of the file"},
      {"surface", "short.stl", "a binary STL of 36 triangles has 1884 bytes where this one has 200"},
      {"surface", "flat.stl", "flat.stl: expected at least one triangle that has an area"},
      {"surface", "ragged.csv", "it begins neither with \"solid\" nor with \"$MeshFormat\""},
      {"height_map", "ragged.csv", "ragged.csv:2: expected 3 numbers, as in the lines before, got 2"},
      {"height_map", "words.csv", "words.csv:2: expected a number, got \"four\""},
      {"height_map", "line.csv", "line.csv: expected at least 2 × 2 heights, got 1 × 3"},
      {"height_map", "short.pgm", "short.pgm: byte 11: the file ends before the last value"},
      {"height_map", "large.pgm", "large.pgm: byte 16: expected a value up to 3, got 4"},
      {"height_map", "huge.pgm", "expected at most 2^28 values, got 4294967296"},
      {"height_map", "picture.png", "picture.png: byte 0: expected the eight bytes that a PNG begins with"},
  };
  const auto refused = [&](const nlohmann::json& obstacle, const std::string& key,
                           const std::string& message) {
    nlohmann::json input = brick("{}");
    input["contact"][0]["obstacle"] = obstacle;
    place.put_json("brick.json", input);
    const Outcome outcome = place.run("check brick.json");
    INFO(outcome.error);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find("contact[0].obstacle." + key) != std::string::npos);
    CHECK(outcome.error.find(message) != std::string::npos);
  };
  for (const Row& row : rows) {
    nlohmann::json obstacle;
    obstacle[row.kind]["file"] = row.file;
    if (std::strcmp(row.kind, "height_map") == 0) {
      obstacle[row.kind]["lower"] = {0, 0};
      obstacle[row.kind]["upper"] = {2, 1};
    }
    refused(obstacle, std::string(row.kind) + ".file: ", row.message);
  }
  refused(parsed(R"({"surface": {"file": "ball.msh", "group": "tol"}})"), "surface.file: ",
          "expected a physical surface of the name \"tol\", the file has \"tool\", \"other\"");
  refused(parsed(R"({"surface": {"file": "words.stl", "group": "a"}})"),
          "surface.file: ", "expected a Gmsh file, the only one that has a group \"a\"");
  refused(parsed(R"({"height_map": {"file": "a.csv", "lower": [0], "upper": [2, 1]}})"),
          "height_map.lower: ", "expected a list of two numbers, x and y");
  refused(parsed(R"({"cone": {"apex": [0, 0, 0], "axis": [0, 0, 1], "half_angle": 91}})"),
          "cone.half_angle: ", "expected an angle in degrees above 0 and below 90, got 91");
}

TEST_CASE("spheres that touch at the same place press as a plane does, or say what they cannot know") {
  const Workplace place;
  nlohmann::json block = parsed(R"({
    "mesh": {"box": {"size": [1, 1, 1], "cells": [3, 3, 3], "element": "hex8"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3}],
    "boundary": [{"on": "top", "displacement": [0, 0, -0.001]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
    "output": {"report": false, "checkpoint": false}
  })");
  const auto force = [&] { return place.json("out/result.json")["contact_force"][2].get<double>(); };
  place.put_json("case.json", block);
  REQUIRE(place.run("run case.json --output out").exit_code == 0);
  const double of_plane = force();
  std::string statuses;
  for (int power = 6; power <= 38; power += 4) {
    CAPTURE(power);
    const double radius = std::pow(10.0, power);
    block["contact"][0]["obstacle"] = {{"sphere", {{"centre", {0.5, 0.5, -radius}}, {"radius", radius}}}};
    place.put_json("case.json", block);
    const Outcome outcome = place.run("run case.json --output out");
    if (outcome.exit_code == 2) {
      CHECK(outcome.error.find("contact[0].obstacle.sphere: expected an obstacle not so large") !=
            std::string::npos);
      statuses += 'r';
      continue;
    }
    const nlohmann::json result = place.json("out/result.json");
    CHECK(force() == doctest::Approx(of_plane).epsilon(std::max(1e3 / radius, 1e-6)));
    CHECK((result["status"] == "converged") == (outcome.exit_code == 0));
    CHECK((place.run("verify case.json --output out").exit_code == 0) == (outcome.exit_code == 0));
    const bool warned = result["warnings"].dump().find("so large or so far away") != std::string::npos;
    CHECK(warned == (power > 7));
    if (outcome.exit_code == 1) CHECK(result["status"] == "limited_by_rounding");
    statuses += outcome.exit_code == 0 ? 'c' : 'l';
  }
  CHECK(statuses == "cccclllrr");
}

TEST_CASE("a load step in which nothing touches costs nothing, and leaves no scale to the next") {
  const Workplace place;
  place.put_json("disc.json", parsed(R"({
    "mesh": {"box": {"size": [1, 1], "cells": [24, 24], "element": "quad4"}}, "plane": "axisymmetric",
    "material": [{"on": "all", "young": 1000, "poisson": 0.3}],
    "boundary": [{"on": "bottom", "displacement": [0, 0]}],
    "contact": [{"on": "top",
      "obstacle": {"sphere": {"centre": [0, 1.51], "radius": 0.5, "direction": [0, 1]}},
      "motion": {"path": [{"time": 1, "translation": [0, -0.009]}, {"time": 2, "translation": [0, -0.02]}]}}],
    "steps": [{"time": 1, "factors": {}}, {"time": 2, "factors": {}}], "output": {"report": false}
  })"));
  REQUIRE(place.run("run disc.json --output out").exit_code == 0);
  const nlohmann::json steps = place.json("out/result.json")["load_steps"];
  CHECK(steps[0]["cg_iterations"] == 0);
  CHECK(steps[0]["contact_force"] == nlohmann::json{0.0, 0.0});
  // As much as a solve to the tolerance takes, and not one to the rounding of what was there before: 2,029.
  CHECK(steps[1]["cg_iterations"] < 100);
  CHECK(place.run("verify disc.json --output out").exit_code == 0);
}
