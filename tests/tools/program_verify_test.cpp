// SPDX-License-Identifier: BSD-3-Clause
// kacanov verify accepts correct answers, also in rewritten files, and rejects tampered ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "formats/inflate.hpp"
#include "formats/vtu_arrays.hpp"
#include "mesh_writer.hpp"
#include "program_runner.hpp"
#include "turned_body.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

nlohmann::json cube(const std::string& element) {
  nlohmann::json cube = parsed(R"({
    "mesh": {"box": {"size": [2, 1, 1], "cells": [4, 2, 2]}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3, "law": {"type": "power", "x0": 0.001, "n": 0.5}}],
    "boundary": [{"on": "top", "displacement": [0.002, null, -0.004]}, {"on": "left", "pressure": 0.1},
                 {"on": "all", "body_force": [0, 0.05, -0.1]}],
    "contact": [{"on": "bottom", "obstacle": {"sphere": {"centre": [1, 0.5, -3], "radius": 3}},
                 "friction": {"coulomb": 0.3}},
                {"on": "right", "obstacle": {"gap": 0.001}, "friction": {"tresca": 0.05}}],
    "output": {"report": false}})");
  cube["mesh"]["box"]["element"] = element;
  return cube;
}

/// Returns a file of compressed arrays with plain ones, as older versions wrote them.
std::string with_plain_arrays(std::string text) {
  const std::string compressor = " compressor=\"vtkZLibDataCompressor\"";
  REQUIRE(text.find(compressor) != std::string::npos);
  text.erase(text.find(compressor), compressor.size());
  const std::size_t appended = text.find("<AppendedData"), data = text.find('_', appended) + 1;
  std::string head, arrays;
  std::size_t done = 0;
  for (std::size_t at = 0; (at = text.find("offset=\"", at)) < appended;) {
    at += 8;
    const std::size_t front = data + std::stoul(text.substr(at));
    const auto number = [&](std::size_t i) {
      std::uint64_t value = 0;
      std::memcpy(&value, text.data() + front + 8 * i, sizeof value);
      return static_cast<std::size_t>(value);
    };
    const std::size_t blocks = number(0), length = number(1), last = number(2);
    const std::uint64_t bytes = last > 0 ? (blocks - 1) * length + last : blocks * length;
    std::string array(bytes, '\0');
    std::size_t from = front + 8 * (3 + blocks), to = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t size = b + 1 == blocks && last > 0 ? last : length;
      REQUIRE(inflate_zlib(std::string_view(text).substr(from, number(3 + b)),
                           {reinterpret_cast<unsigned char*>(array.data()) + to, size}));
      from += number(3 + b);
      to += size;
    }
    head += text.substr(done, at - done) + std::to_string(arrays.size());
    done = text.find('"', at);
    arrays.append(reinterpret_cast<const char*>(&bytes), sizeof bytes).append(array);
  }
  return head + text.substr(done, data - done) + arrays + "\n</AppendedData>\n</VTKFile>\n";
}

/// Adds to the x component of one node in an array of doubles of a VTU file; arrays start with their length.
void change_array(const Workplace& place, const std::string& file, const std::string& name, double by,
                  std::size_t node = 2) {
  std::string text = with_plain_arrays(contents(place.path(file)));
  const std::size_t at = text.find("Name=\"" + name + "\"");
  REQUIRE(at != std::string::npos);
  const std::size_t offset = text.find("offset=\"", at) + 8;
  const std::size_t data = text.find('_', text.find("<AppendedData")) + 1;
  const std::size_t width = name == "pressure" ? 1 : 3;
  const std::size_t place_of_number =
      data + std::stoul(text.substr(offset)) + sizeof(std::uint64_t) + node * width * sizeof(double);
  double value = 0.0;
  std::memcpy(&value, text.data() + place_of_number, sizeof value);
  value += by;
  std::memcpy(text.data() + place_of_number, &value, sizeof value);
  place.put(file, text);
}

}  // namespace

TEST_CASE("what has converged is verified from its files, of every element, on one rank and two") {
  const Workplace place;
  for (const char* element : {"tet4", "tet10", "hex8"}) {
    INFO(element);
    place.put_json("cube.json", cube(element));
    for (const char* ranks : {"1", "2"}) {
      const Outcome run = place.run(std::string("run cube.json --output out --ranks ") + ranks);
      INFO(run.error);
      REQUIRE(run.exit_code == 0);
      const Outcome outcome = place.run("verify cube.json --output out");
      INFO(outcome.error, outcome.output);
      CHECK(outcome.exit_code == 0);
      CHECK(outcome.output.find("the answer meets its tolerance 1.00e-06") != std::string::npos);
      for (const char* name : {"equilibrium", "duality_gap", "contact_force[z]", "max_contact_pressure"})
        CHECK(outcome.output.find(name) != std::string::npos);
    }
  }
  // A tolerance that the answer does not meet, and other cases on the same mesh.
  const Outcome outcome = place.run("verify cube.json --output out --set solver.tolerance=1e-15");
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("does not meet its tolerance") != std::string::npos);
  CHECK(place.run("verify cube.json --output out --set material[0].young=201").exit_code == 1);
  CHECK(place.run("verify cube.json --output out --set contact[0].friction.coulomb=0.2").exit_code == 1);
}

TEST_CASE("plane stress and bodies of revolution are verified from their files, on one rank and two") {
  const Workplace place;
  nlohmann::json flat = parsed(R"({
    "mesh": {"box": {"size": [2, 1], "cells": [16, 8]}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3, "law": {"type": "power", "x0": 0.001, "n": 0.5}}],
    "boundary": [{"on": "top", "displacement": [0, -0.004], "name": "top"}, {"on": "right", "pressure": 0.1},
                 {"on": "right", "spring": 2.0}, {"on": "right", "traction": [0, 0.05]},
                 {"on": "all", "body_force": [0.01, -0.1]}],
    "contact": [{"on": "bottom", "obstacle": {"sphere": {"centre": [0, -30], "radius": 30}}, "name": "ball",
                 "friction": {"coulomb": 0.3}}],
    "output": {"report": false}})");
  for (const char* plane : {"stress", "axisymmetric"})
    for (const char* element : {"tri3", "quad4"}) {
      INFO(plane, " ", element);
      nlohmann::json input = flat;
      input["plane"] = plane;
      input["mesh"]["box"]["element"] = element;
      if (std::string(plane) == "axisymmetric") {
        input["material"][0]["expansion"] = 1e-4;
        input["boundary"].push_back({{"on", "all"}, {"temperature", 5}});
        input["boundary"].push_back({{"on", "left"}, {"spring", {1, 2}}, {"name", "axis"}});
      }
      place.put_json("flat.json", input);
      nlohmann::json first;
      for (const char* ranks : {"1", "2"}) {
        const Outcome run = place.run(std::string("run flat.json --output out --ranks ") + ranks);
        INFO(run.error);
        REQUIRE(run.exit_code == 0);
        const Outcome outcome = place.run("verify flat.json --output out");
        INFO(outcome.error, outcome.output);
        CHECK(outcome.exit_code == 0);
        const nlohmann::json result = place.json("out/result.json");
        // The axis has no area.
        if (input["plane"] == "axisymmetric")
          CHECK(result["reaction"]["axis"]["force"] == nlohmann::json{0.0, 0.0});
        CHECK(result["plastic_elements"].get<int>() > 0);
        CHECK(result["contact"]["ball"]["sticking"].get<int>() +
                  result["contact"]["ball"]["slipping"].get<int>() >
              2);
        if (first.is_null()) first = result;
        const double force = first["contact_force"][1];
        CHECK(result["contact_force"][1].get<double>() == doctest::Approx(force).epsilon(1e-5));
      }
      // The verifier must not accept the body as plane strain.
      CHECK(place.run("verify flat.json --output out --set plane=strain").exit_code == 1);
    }
}

TEST_CASE("what has been changed in the files is found") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const auto verified = [&] { return place.run("verify beam.json --output out"); };
  const auto renewed = [&] { REQUIRE(place.run("run beam.json --output out").exit_code == 0); };
  renewed();
  REQUIRE(verified().exit_code == 0);

  nlohmann::json result = place.json("out/result.json");
  result["contact_force"][1] = result["contact_force"][1].get<double>() * (1 + 1e-9);
  place.put_json("out/result.json", result);
  Outcome outcome = verified();
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("differs") != std::string::npos);
  result = nlohmann::json{{"status", "failed"}, {"message", "error: of some kind"}};
  place.put_json("out/result.json", result);
  CHECK(verified().exit_code == 2);

  struct Change {
    const char *file, *array;
    double by;
  };
  for (const Change& change :
       {Change{"out/body.vtu", "displacement", 1e-5}, Change{"out/contact.vtu", "pressure", 1e-4},
        Change{"out/contact.vtu", "tangential_traction", 1e-4}}) {
    INFO(change.array);
    renewed();
    change_array(place, change.file, change.array, change.by);
    CHECK(verified().exit_code == 1);
  }
  renewed();
  change_array(place, "out/body.vtu", "Points", 1e-3);
  CHECK(verified().exit_code == 2);
  renewed();
  std::filesystem::remove(place.path("out/contact.vtu"));
  outcome = verified();
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error.find("cannot be read") != std::string::npos);
}

TEST_CASE("elements have the numbers of their material and set, on one rank, on two, and from parts") {
  const Workplace place;
  // Two rows of cubes along x: the upper one of another material; the last column forms a set in which no
  // cube comes first.
  std::string mesh = "*NODE\n";
  int node = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 5; ++x)
        mesh += std::to_string(++node) + "," + std::to_string(x) + "," + std::to_string(y) + "," +
                std::to_string(z) + "\n";
  for (int z = 0; z < 2; ++z) {
    mesh += std::string("*ELEMENT, TYPE=C3D8, ELSET=") + (z == 0 ? "Lower" : "Upper") + "\n";
    for (int x = 0; x < 4; ++x) {
      mesh += std::to_string(4 * z + x + 1);
      for (const int up : {0, 10})
        for (const int corner : {1, 2, 7, 6}) mesh += "," + std::to_string(10 * z + x + up + corner);
      mesh += "\n";
    }
  }
  place.put("two.inp", mesh + "*ELSET, ELSET=Column\n4, 8\n");
  place.put_json("two.json", parsed(R"({
    "mesh": {"file": "two.inp"},
    "material": [{"on": "all", "young": 200, "poisson": 0.3}, {"on": "Upper", "young": 100, "poisson": 0.3}],
    "boundary": [{"on": {"box": [[0, 0, 0], [0, 1, 2]]}, "displacement": [0, 0, 0]},
                 {"on": {"box": [[0, 0, 2], [4, 1, 2]]}, "pressure": 0.1}]})"));
  REQUIRE(place.run("partition two.json --ranks 2 --output parts").exit_code == 0);
  for (const char* how : {"--ranks 1", "--ranks 2", "--parts parts"}) {
    INFO(how);
    REQUIRE(place.run(std::string("run two.json --output out ") + how).exit_code == 0);
    const nlohmann::json names = place.json("out/result.json")["mesh"]["sets"];
    REQUIRE(names.size() == 3);
    const std::string bytes = contents(place.path("out/body.vtu"));
    const VtuFile file("body.vtu", bytes);
    const auto elements = file.integers("CellData", "element_id", 8),
               sets = file.integers("CellData", "set", 8),
               materials = file.integers("CellData", "material", 8);
    std::vector<bool> seen(8, false);
    for (std::size_t e = 0; e < 8; ++e) {
      const bool upper = elements[e] > 4, column = elements[e] % 4 == 0;
      const std::string name = names[static_cast<std::size_t>(sets[e]) - 1];
      CHECK(materials[e] == (upper ? 1 : 0));
      // An element of two sets gets the first one.
      CHECK((name == (upper ? "Upper" : "Lower") || (column && name == "Column")));
      seen[static_cast<std::size_t>(elements[e]) - 1] = true;
    }
    CHECK(std::count(seen.begin(), seen.end(), true) == 8);
    // Strain and stress satisfy the same law.
    const auto stress = file.reals("CellData", "stress", 48), strain = file.reals("CellData", "strain", 48);
    for (std::size_t e = 0; e < 8; ++e) {
      const double shear = (materials[e] == 0 ? 200.0 : 100.0) / (2 * 1.3);
      CHECK(stress[6 * e + 3] == doctest::Approx(2 * shear * strain[6 * e + 3]).epsilon(1e-9).scale(0.01));
      CHECK(stress[6 * e] - stress[6 * e + 1] ==
            doctest::Approx(2 * shear * (strain[6 * e] - strain[6 * e + 1])).epsilon(1e-9).scale(0.01));
    }
  }
}

TEST_CASE("what older versions wrote is verified: plain arrays, the body in a piece a rank") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output out").exit_code == 0);
  for (const char* file : {"out/body.vtu", "out/contact.vtu"})
    place.put(file, with_plain_arrays(contents(place.path(file))));
  CHECK(place.run("verify beam.json --output out").exit_code == 0);
  std::filesystem::rename(place.path("out/body.vtu"), place.path("out/body_0.vtu"));
  place.put("out/body.pvtu", "<VTKFile>\n<Piece Source=\"body_0.vtu\"/>\n</VTKFile>\n");
  CHECK(place.run("verify beam.json --output out").exit_code == 0);
  // A new run in the folder removes them.
  REQUIRE(place.run("run beam.json --output out").exit_code == 0);
  CHECK_FALSE(place.has("out/body.pvtu"));
  CHECK_FALSE(place.has("out/body_0.vtu"));
}

TEST_CASE("files of fields that are damaged are refused by name, whatever is wrong") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output out").exit_code == 0);
  for (const std::string file : {"out/body.vtu", "out/contact.vtu"}) {
    const std::string whole = contents(place.path(file));
    const auto refuse = [&](const std::string& text) {
      place.put(file, text);
      const Outcome outcome = place.run("verify beam.json --output out");
      CHECK(outcome.exit_code == 2);
      CHECK(outcome.error.find(file) != std::string::npos);
    };
    const auto refused = [&](const std::string& what, const std::string& instead) {
      INFO(file, ": ", what, " ", instead);
      std::string text = whole;
      text.replace(text.find(what), what.size(), instead);
      refuse(text);
    };
    const std::size_t first = whole.find("offset=\"") + 8;
    const std::string offset_of_first = whole.substr(first, whole.find('"', first) - first);
    for (const char* offset : {"x", "", "-1", "18446744073709551612", "99999999999999999999999", "1e9"})
      refused("offset=\"" + offset_of_first + "\"", std::string("offset=\"") + offset + "\"");
    // Number of blocks, block length, length of the last block, compressed lengths; then the compressed data.
    const std::size_t front = whole.find('_', whole.find("<AppendedData")) + 1 + std::stoul(offset_of_first);
    for (const std::size_t number : {0, 2, 3, 5}) {
      for (const char* instead : {"\xff\xff\xff\xff\xff\xff\xff\xff", "\x07\x01\x02\x00\x00\x00\x00\x00"}) {
        std::string text = whole;
        text.replace(front + 8 * number, 8, std::string(instead, 8));
        refuse(text);
      }
    }
    refused("NumberOfComponents=\"3\"", "NumberOfComponents=\"\xff\"");
    refused("NumberOfComponents=\"3\"", "NumberOfComponents=\"0\"");
    refused("<AppendedData", "<AppendedDatum");
    refused("node_id", "mode_id");
    place.put(file, whole);
  }
}

TEST_CASE("an answer that has not converged is not verified, and its certificate is right all the same") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=2").exit_code == 1);
  const Outcome outcome = place.run("verify beam.json --output out");
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("does not meet its tolerance") != std::string::npos);
  CHECK(outcome.output.find("differs") == std::string::npos);
}

TEST_CASE("numbers of a part of the load are recomputed at that part") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  // A softening material: beyond some load no equilibrium exists.
  beam["mesh"]["box"] = {{"size", {4, 1}}, {"cells", {4, 1}}, {"element", "quad4"}};
  beam["material"][0]["law"] = {{"type", "logarithmic"}, {"argument", "squared"}, {"x0", 1e-6}};
  beam["boundary"][1] = {{"on", "top"}, {"traction", {0, -0.002}}};
  beam["contact"][0] = {{"on", "bottom"}, {"obstacle", {{"gap", 0.5}}}};
  place.put_json("beam.json", beam);
  REQUIRE(place.run("run beam.json --output out").exit_code == 1);
  const nlohmann::json result = place.json("out/result.json");
  REQUIRE(result["load_factor"].get<double>() < 1.0);
  REQUIRE(result["load_factor"] == result["load_reached"]);
  const Outcome outcome = place.run("verify beam.json --output out");
  INFO(outcome.output, outcome.error);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("differs") == std::string::npos);
  CHECK(outcome.output.find("the result says not_converged") != std::string::npos);
}

TEST_CASE("the verifier reads every form of Gmsh's format by itself") {
  const Workplace place;
  nlohmann::json input = cube("hex8");
  for (const ElementType type : {ElementType::tet10, ElementType::hex8})
    for (const GmshForm& form : {GmshForm{true, false, false, false}, GmshForm{true, true, true, false},
                                 GmshForm{false, false, false, true}, GmshForm{false, true, false, false}}) {
      place.put("cube.msh", gmsh_file(make_box({{2, 1, 1}, {4, 2, 2}, type}), form));
      input["mesh"] = {{"file", "cube.msh"}};
      place.put_json("cube.json", input);
      REQUIRE(place.run("run cube.json --output out").exit_code == 0);
      const Outcome outcome = place.run("verify cube.json --output out");
      INFO(outcome.output, outcome.error);
      CHECK(outcome.exit_code == 0);
    }
}

TEST_CASE(
    "supports in any frame are where they are prescribed, to rounding, and verify finds one that is off by "
    "more") {
  const Workplace place;
  const BoxSpec box{{2, 1, 1}, {5, 3, 3}, ElementType::hex8};
  // Rotated by 0.5 about (1, 2, 2)/3; the second frame differs from the first by a millionth.
  for (const double apart : {0.7, 1e-6}) {
    put_mesh(place, box, turned);
    const nlohmann::json x = list(turned({1, 0, 0})), y = list(turned({0, 1, 0})),
                         z = list(turned({0, 0, 1}));
    const nlohmann::json near = list(turned({std::cos(apart), std::sin(apart), 0})),
                         beside = list(turned({-std::sin(apart), std::cos(apart), 0}));
    const nlohmann::json none;
    nlohmann::json input = parsed(R"({
      "mesh": {"file": "body.msh"}, "solver": {"tolerance": 1e-8, "load_steps": 3},
      "material": [{"on": "all", "young": 200, "poisson": 0.4, "law": {"type": "power", "x0": 0.001, "n": 0.5}}],
      "output": {"report": false}})");
    input["boundary"] = {
        {{"on", "left"}, {"frame", {x, y, z}}, {"displacement", {0, none, none}}},
        {{"on", "bottom"}, {"frame", {near, beside, z}}, {"displacement", {none, none, 0.001}}},
        {{"on", "front"}, {"frame", {near, beside, z}}, {"displacement", {none, 1e-3 * apart, none}}},
        {{"on", "right"}, {"traction", turned({0.3, 0.05, 0.02})}}};
    place.put_json("case.json", input);
    REQUIRE(place.run("run case.json --output out").exit_code == 0);
    const Outcome outcome = place.run("verify case.json --output out");
    INFO(apart, outcome.output, outcome.error);
    CHECK(outcome.exit_code == 0);

    const std::string bytes = contents(place.path("out/body.vtu"));
    const VtuFile file("body.vtu", bytes);
    const std::size_t nodes = 6 * 4 * 4;
    const auto points = file.reals("Points", "Points", 3 * nodes),
               u = file.reals("PointData", "displacement", 3 * nodes);
    double most = 0;
    for (const double component : u) most = std::max(most, std::abs(component));
    for (std::size_t n = 0; n < nodes; ++n) {
      double along = 0;
      const Point normal = turned({1, 0, 0});
      for (std::size_t c = 0; c < 3; ++c) along += normal[c] * points[3 * n + c];
      if (std::abs(along) > 1e-9) continue;  // on the left side
      change_array(place, "out/body.vtu", "displacement", 1e-13 * most, n);
      break;
    }
    const Outcome changed = place.run("verify case.json --output out");
    INFO(changed.output, changed.error);
    CHECK(changed.exit_code == 1);
    CHECK(changed.output.find("the supports are not where they are prescribed") != std::string::npos);
  }
}

TEST_CASE("a body far from the origin has the numbers of the same body at the origin") {
  // Coordinates and their shift are multiples of 2^-20, so that both bodies are bitwise the same.
  const auto on_grid = [](double x) { return std::ldexp(std::round(std::ldexp(x, 20)), -20); };
  for (const ElementType type : {ElementType::tet10, ElementType::hex8, ElementType::quad4}) {
    INFO(static_cast<int>(type));
    const bool flat = type == ElementType::quad4;
    nlohmann::json at_origin;
    for (const double shift : {0.0, std::ldexp(1.0, 17), std::ldexp(1.0, 30)}) {
      const Workplace place;
      const BoxSpec box = flat ? BoxSpec{{2, 1}, {6, 4}, type} : BoxSpec{{2, 1, 1}, {4, 2, 2}, type};
      put_mesh(place, box, [&](const Point& x) {
        return Point{on_grid(x[0] + 0.1 * x[1] * x[1]) + shift, on_grid(x[1] + 0.05 * x[0]) - shift,
                     flat ? 0 : on_grid(x[2] * (1 + 0.1 * x[1])) + shift};
      });
      nlohmann::json input = parsed(R"({
        "mesh": {"file": "body.msh"}, "solver": {"tolerance": 1e-9}, "output": {"report": false},
        "material": [{"on": "all", "young": 200, "poisson": 0.3,
                      "law": {"type": "power", "x0": 0.001, "n": 0.5}}],
        "boundary": [{"on": "top", "displacement": [0, 0, -0.004]}, {"on": "right", "pressure": 0.1},
                     {"on": "all", "body_force": [0, 0.05, -0.1]}],
        "contact": [{"on": "bottom", "friction": {"coulomb": 0.3}}]})");
      const double near = flat ? 0.0625 : 0.5;
      nlohmann::json below = {1 + shift, -shift - 3}, point = {1 + shift, near - shift};
      if (!flat) {
        below = {1 + shift, 0.5 - shift, shift - 3};
        point.push_back(0.25 + shift);
      } else {
        input["boundary"][0]["displacement"] = {0, -0.004};
        input["boundary"][2]["body_force"] = {0.05, -0.1};
      }
      input["contact"][0]["obstacle"] = {{"sphere", {{"centre", below}, {"radius", 3}}}};
      input["probe"] = nlohmann::json::array({point});
      place.put_json("case.json", input);
      const Outcome run = place.run("run case.json --output out");
      INFO(shift, run.error, run.output);
      REQUIRE(run.exit_code == 0);
      const Outcome outcome = place.run("verify case.json --output out");
      INFO(outcome.output, outcome.error);
      CHECK(outcome.exit_code == 0);
      const nlohmann::json result = place.json("out/result.json");
      CHECK((result["warnings"].dump().find("so far from the origin") != std::string::npos) == (shift > 1e9));
      if (at_origin.is_null()) at_origin = result;
      for (const char* name : {"max_von_mises", "max_contact_pressure"})
        CHECK(result[name].get<double>() == doctest::Approx(at_origin[name].get<double>()).epsilon(1e-7));
      const double all = at_origin["contact_force"].back();
      for (std::size_t c = 0; c < point.size(); ++c) {
        CHECK(std::abs(result["contact_force"][c].get<double>() -
                       at_origin["contact_force"][c].get<double>()) <= 1e-7 * all);
        CHECK(std::abs(result["load"]["boundary[1]"]["force"][c].get<double>() -
                       at_origin["load"]["boundary[1]"]["force"][c].get<double>()) <= 1e-14 * all);
        CHECK(std::abs(result["probe"][0][c].get<double>() - at_origin["probe"][0][c].get<double>()) <=
              1e-10);
      }
      // Positions are bitwise those of the user.
      const std::string bytes = contents(place.path("out/body.vtu"));
      const VtuFile file("body.vtu", bytes);
      const std::size_t nodes = result["mesh"]["nodes"];
      for (const double x : file.reals("Points", "Points", 3 * nodes)) CHECK(on_grid(x) == x);
    }
  }
}

TEST_CASE("nodes of no element are left out, as the run leaves them out") {
  const Workplace place;
  Mesh mesh = make_box({{2, 1, 1}, {4, 2, 2}, ElementType::hex8});
  std::string text = gmsh_file(mesh, {.new_format = false});
  const std::size_t count = text.find('\n', text.find("$Nodes")) + 1, end = text.find('\n', count);
  const int nodes = std::stoi(text.substr(count, end - count));
  text.insert(text.find("$EndNodes"), std::to_string(nodes + 1000) + " 50 50 50\n");
  text.replace(count, end - count, std::to_string(nodes + 1));
  place.put("cube.msh", text);
  nlohmann::json input = cube("hex8");
  input["mesh"] = {{"file", "cube.msh"}};
  place.put_json("cube.json", input);
  REQUIRE(place.run("run cube.json --output out").exit_code == 0);
  CHECK(place.json("out/result.json")["warnings"].dump().find("belongs to no element") != std::string::npos);
  const Outcome outcome = place.run("verify cube.json --output out");
  INFO(outcome.output, outcome.error);
  CHECK(outcome.exit_code == 0);
}

TEST_CASE("every total of the result is recomputed: what has been changed in one is found, by its name") {
  const Workplace place;
  nlohmann::json input = cube("hex8");
  input["boundary"].push_back({{"on", "front"}, {"spring", 3}, {"name", "bed"}});
  input["boundary"][0]["name"] = "lid";
  input["contact"][0]["name"] = "ball";
  input["probe"] = {{0.3, 0.4, 0.9}, {2, 1, 1}};
  place.put_json("cube.json", input);
  REQUIRE(place.run("run cube.json --output out").exit_code == 0);
  const nlohmann::json result = place.json("out/result.json");
  const Outcome right = place.run("verify cube.json --output out");
  INFO(right.output, right.error);
  REQUIRE(right.exit_code == 0);
  for (const char* path :
       {"/probe/0/2", "/probe/1/1", "/reaction/lid/force/2", "/reaction/lid/moment/0",
        "/reaction/bed/force/1", "/load/boundary[1]/force/0", "/load/boundary[2]/moment/1",
        "/contact/ball/force/2", "/contact/ball/normal_force/2", "/contact/ball/friction_force/0",
        "/contact/ball/moment/1", "/contact/ball/area", "/contact/ball/max_pressure",
        "/contact/contact[1]/force/0", "/max_displacement/value"}) {
    INFO(path);
    nlohmann::json changed = result;
    nlohmann::json& number = changed.at(nlohmann::json::json_pointer(path));
    number = number.get<double>() * (1 + 1e-7);
    place.put_json("out/result.json", changed);
    const Outcome outcome = place.run("verify cube.json --output out");
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.output.find("differs") != std::string::npos);
  }
  for (const char* path : {"/active_nodes", "/slip_nodes", "/contact/ball/sticking", "/contact/ball/open"}) {
    INFO(path);
    nlohmann::json changed = result;
    nlohmann::json& number = changed.at(nlohmann::json::json_pointer(path));
    number = number.get<int>() + 1;
    place.put_json("out/result.json", changed);
    CHECK(place.run("verify cube.json --output out").exit_code == 1);
  }
  // Half of the load must not pass as the full load.
  place.put_json("cube.json", input);
  REQUIRE(place.run("run cube.json --output out --set solver.load_steps=2").exit_code == 0);
  nlohmann::json half = place.json("out/result.json");
  half["load_factor"] = 0.5;
  place.put_json("out/result.json", half);
  CHECK(place.run("verify cube.json --output out").exit_code != 0);
}
