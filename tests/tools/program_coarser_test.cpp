// SPDX-License-Identifier: BSD-3-Clause
// mesh.files: start from coarser meshes of the same body that the case names.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <kacanov/mesh.hpp>
#include "mesh_writer.hpp"
#include "program_runner.hpp"

using namespace kacanov;
using namespace kacanov::testing;
using nlohmann::json;

namespace {

/// A box with perturbed inner nodes, so that the meshes are not nested.
Mesh moved_box(ElementType type, int cells) {
  const BoxSpec box{{1.0, 1.0, 1.0}, {cells, cells, cells}, type};
  Mesh mesh = make_box(box);
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    double* x = &mesh.coordinates[3 * n];
    double wave = 0.05;
    for (std::size_t c = 0; c < 3; ++c) wave *= std::sin(std::numbers::pi * x[c]);
    for (std::size_t c = 0; c < 3; ++c) x[c] += wave * static_cast<double>(c + 1);
  }
  return mesh;
}

/// A ball pressed into the top of a plastic block.
json pressed(const json& files) {
  json input = parsed(R"({
    "mesh": {},
    "material": [{"on": "all", "young": 200, "poisson": 0.3, "law": {"type": "logarithmic", "yield_stress": 1}}],
    "boundary": [{"on": "bottom", "displacement": [0, 0, 0]}],
    "contact": [{"on": "top", "obstacle": {"sphere": {"centre": [0.5, 0.5, 2.98], "radius": 2}},
                 "friction": {"coulomb": 0.2}}],
    "probe": [[1, 1, 1]], "output": {"report": false}})");
  input["mesh"]["files"] = files;
  return input;
}

bool warns(const json& result, const std::string& of) {
  return result["warnings"].dump().find(of) != std::string::npos;
}

}  // namespace

TEST_CASE("a run starts from coarser meshes of the same body that the case names") {
  const Workplace place;
  place.put("coarse.msh", gmsh_file(moved_box(ElementType::tet4, 4), {}));
  place.put("medium.msh", gmsh_file(moved_box(ElementType::tet4, 7), {}));
  place.put("fine.msh", gmsh_file(moved_box(ElementType::tet10, 6), {}));
  place.put_json("three.json", pressed({"coarse.msh", "medium.msh", "fine.msh"}));
  place.put_json("one.json", pressed({"fine.msh"}));
  for (const char* run : {"run three.json --ranks 1 --output three", "run three.json --ranks 2 --output two",
                          "run one.json --output one", "verify three.json --output three"}) {
    const Outcome outcome = place.run(run);
    INFO("error: ", outcome.error);
    CHECK(outcome.exit_code == 0);
  }
  const json one = place.json("one/result.json");
  CHECK_FALSE(one.contains("nested"));
  for (const char* of : {"three", "two"}) {
    const json result = place.json(std::string(of) + "/result.json");
    REQUIRE(result["nested"].size() == 2);
    CHECK(result["nested"][0]["unknowns"] == 3 * 5 * 5 * 5);
    CHECK(result["nested"][1]["unknowns"] == 3 * 8 * 8 * 8);
    CHECK(result["outer_iterations"] < one["outer_iterations"]);
    CHECK(result["discretisation"]["meshes"] == 1);  // the meshes are not nested refinements
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(result["contact_force"][c].get<double>() ==
            doctest::Approx(one["contact_force"][c].get<double>()).epsilon(1e-4).scale(0.01));
  }
  CHECK(place.run("run three.json --set solver.nested=false --output none").exit_code == 0);
  CHECK_FALSE(place.json("none/result.json").contains("nested"));
}

TEST_CASE("refinement of the last of the files goes on from the others") {
  const Workplace place;
  place.put("coarse.msh", gmsh_file(moved_box(ElementType::tet4, 2), {}));
  place.put("fine.msh", gmsh_file(moved_box(ElementType::tet4, 3), {}));
  json input = pressed({"coarse.msh", "fine.msh"});
  input["mesh"]["refine"] = 1;
  place.put_json("case.json", input);
  REQUIRE(place.run("run case.json --output out").exit_code == 0);
  const json result = place.json("out/result.json");
  REQUIRE(result["nested"].size() == 2);
  CHECK(result["nested"][1]["unknowns"] == 3 * 4 * 4 * 4);
  CHECK(result["unknowns"] == 3 * 7 * 7 * 7);
  CHECK(result["discretisation"]["meshes"] == 2);
}

TEST_CASE(
    "a coarser mesh that the case does not fit is passed over with a warning, what is no mesh refused") {
  const Workplace place;
  Mesh nameless = moved_box(ElementType::tet4, 2);
  nameless.groups.clear();
  place.put("nameless.msh", gmsh_file(nameless, {}));
  place.put("fine.msh", gmsh_file(moved_box(ElementType::tet4, 4), {}));
  place.put("text.msh", "no mesh\n");
  place.put("flat.msh", gmsh_file(make_box({{1.0, 1.0, 0.0}, {2, 2, 1}, ElementType::tri3}), {}));
  place.put_json("case.json", pressed({"nameless.msh", "fine.msh"}));
  const Outcome passed = place.run("run case.json --output out");
  INFO("error: ", passed.error);
  CHECK(passed.exit_code == 0);
  CHECK(warns(place.json("out/result.json"),
              "mesh.files[0]: the mesh is passed over, the case does not fit it: "));
  const struct {
    json files;
    const char* message;
  } rows[] = {
      {{"text.msh", "fine.msh"}, "mesh.files[0]: "},
      {{"flat.msh", "fine.msh"}, "mesh.files[0]: expected a mesh in 3D, as the last one is"},
      {{"absent.msh", "fine.msh"}, "mesh.files[0]: expected a mesh file, there is no "},
      {json::array(), "mesh.files: expected at least one mesh file"},
      {{"fine.msh", 3}, "mesh.files[1]: expected a string"},
  };
  for (const auto& row : rows) {
    place.put_json("wrong.json", pressed(row.files));
    const Outcome refused = place.run("run wrong.json --output wrong");
    INFO(refused.error);
    CHECK(refused.exit_code == 2);
    CHECK(refused.error.find(row.message) != std::string::npos);
  }
  CHECK(
      place.run("run case.json --set mesh.adapt.error=0.1").error.find("mesh.adapt: expected no \"files\"") !=
      std::string::npos);
}
