// SPDX-License-Identifier: BSD-3-Clause
// Errors in case files: each message names the path and the expected value.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "case_samples.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

std::string syntax_complaint(const std::string& text) {
  try {
    parse_json(text, "beam.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("the sample itself is accepted") {
  const nlohmann::json document = complete_case();
  CHECK_NOTHROW(parse_case(document, ""));
}

TEST_CASE("one mistake, one message: path, what was expected, what was there") {
  struct Row {
    const char* change;
    const char* message;
  };
  const std::vector<Row> rows{
      // Unknown keys, with a suggestion where a known key is similar.
      {"solver.tolerence=1",
       "solver.tolerence: unknown key (did you mean \"tolerance\"?); known here: preset, tolerance,"},
      {"meterial=1", "meterial: unknown key (did you mean \"material\"?)"},
      {"contact[0].obstacle.plane.nromal=[0,0,1]",
       "contact[0].obstacle.plane.nromal: unknown key (did you mean \"normal\"?)"},
      {"zzz=1", "zzz: unknown key; known here: mesh, plane, thickness, material,"},
      {"plane=flat", "plane: expected \"strain\", \"stress\" or \"axisymmetric\", got \"flat\""},
      {"material[0].law.gamma=0.1", "material[0].law.gamma: unknown key"},
      {"output.colour=1", "output.colour: unknown key"},
      // Wrong types.
      {"mesh=3", "mesh: expected an object with the keys file, files, box, refine, order, adapt, got 3"},
      {"material={}", "material: expected a list of materials, got {}"},
      {"material[0].bbar=yes", "material[0].bbar: expected true or false, got \"yes\""},
      {"material[0].young=[1]", "material[0].young: expected a number > 0, got [1]"},
      {"contact[0].friction.tresca=high", "contact[0].friction.tresca: expected a number ≥ 0, got \"high\""},
      {"boundary[0].displacement[1]=free",
       "boundary[0].displacement[1]: expected a number, or null for a free component, got \"free\""},
      {"boundary[1].traction=5", "boundary[1].traction: expected a list of 2 or 3 numbers, got 5"},
      {"boundary[1].traction=[1,2,3,4]",
       "boundary[1].traction: expected a list of 2 or 3 numbers, got [1,2,3,4]"},
      {"boundary[1].traction[2]=null", "boundary[1].traction[2]: expected a number, got null"},
      {"boundary[1].on=7",
       "boundary[1].on: expected a name, \"all\" or {\"box\": [lower corner, upper corner]}, got 7"},
      {"boundary[1].on.box=[[0,0,0]]", "boundary[1].on.box: expected two corners"},
      {"boundary[1].on=", "boundary[1].on: expected a string, got \"\""},
      {"output.scale=0", "output.scale: expected a number > 0, got 0"},
      {"output.report=yes", "output.report: expected true or false, got \"yes\""},
      {"output.fields=vtk",
       "output.fields: expected \"vtu\" or \"none\", got \"vtk\" (did you mean \"vtu\"?)"},
      {"probe=[1,2,3]", "probe[0]: expected a list of 2 or 3 numbers, got 1"},
      // Values out of range.
      {"material[0].young=0", "material[0].young: expected a number > 0, got 0"},
      {"material[0].young=-1", "material[0].young: expected a number > 0, got -1"},
      {"material[0].poisson=0.5", "material[0].poisson: expected a number above -1 and below 0.5, got 0.5"},
      {"material[0].poisson=-1", "material[0].poisson: expected a number above -1 and below 0.5, got -1"},
      {"material[0].law.x0=0", "material[0].law.x0: expected a number > 0, got 0"},
      {"material[0].young=1e300",
       "material[0].young: expected a number > 0 of a magnitude below 1e100, got 1e+300"},
      {"contact[1].obstacle.sphere.radius=-2",
       "contact[1].obstacle.sphere.radius: expected a number > 0, got -2"},
      {"contact[0].obstacle.plane.normal=[0,0,0]",
       "contact[0].obstacle.plane.normal: expected a vector that is not zero"},
      {"contact[0].friction.tresca=-0.01", "contact[0].friction.tresca: expected a number ≥ 0, got -0.01"},
      {"solver.tolerance=1", "solver.tolerance: expected a number above 0 and below 1, got 1"},
      {"solver.max_cg=0", "solver.max_cg: expected a whole number ≥ 1, got 0"},
      {"solver.max_outer=0", "solver.max_outer: expected a whole number ≥ 1, got 0"},
      {"solver.max_outer=2.5", "solver.max_outer: expected a whole number ≥ 1, got 2.5"},
      {"solver.max_contact=1e12",
       "solver.max_contact: expected a whole number ≤ 2147483647, got 1000000000000.0"},
      {"solver.load_steps=0", "solver.load_steps: expected a whole number ≥ 1, got 0"},
      {"solver.load_steps=\"many\"",
       "solver.load_steps: expected a whole number ≥ 1 or a list of factors, got \"many\""},
      {"solver.load_steps=[0,1]", "solver.load_steps[0]: expected a factor ≥ 1e-15, got 0"},
      {"solver.load_steps=[0.5]",
       "solver.load_steps: expected factors on the load of which the last is 1, got [0.5]"},
      {"contact[0].friction.reference=end",
       "contact[0].friction.reference: expected \"start\" or \"step\", got \"end\""},
      {"steps=[]", "steps: expected at least one load step"},
      {"steps=[{\"time\":1}]", "steps[0].factors: this key is missing"},
      {"steps=[{\"factors\":{}}]", "steps[0].time: this key is missing"},
      {"steps=[{\"time\":0,\"factors\":{}}]", "steps[0].time: expected a time after 0, got 0"},
      {"steps=[{\"time\":2,\"factors\":{}},{\"time\":1,\"factors\":{}}]",
       "steps[1].time: expected a time after 2, got 1"},
      {"steps=[{\"time\":1,\"factors\":{\"boundary[9]\":1}}]",
       "steps[0].factors: expected names of entries, or places such as \"boundary[0]\""},
      {"steps=[{\"time\":1,\"factors\":{\"boundary[1]\":\"on\"}}]",
       "steps[0].factors[\"boundary[1]\"]: expected a number, got \"on\""},
      {"steps=[{\"time\":1,\"factors\":{\"boundary[1]\":1e-100}}]",
       "steps: expected factors of \"boundary[1]\" of which one has a magnitude ≥ 1e-15, got at most 1e-100"},
      {"steps=[{\"time\":1,\"factors\":[1]}]",
       "steps[0].factors: expected an object of entries and their factors"},
      {"output.checkpoint=1", "output.checkpoint: expected true or false, got 1"},
      {"solver.relaxation=2", "solver.relaxation: expected a number ≥ 1 and below 2, got 2"},
      {"solver.r=-1", "solver.r: expected \"auto\", \"paper\" or a number > 0, got -1"},
      {"solver.r=best", "solver.r: expected \"auto\", \"paper\" or a number > 0, got \"best\""},
      {"solver.first_r=0", "solver.first_r: expected a number > 0, got 0"},
      {"solver.outer=kakanov",
       "solver.outer: expected \"auto\", \"kacanov\" or \"newton\", got \"kakanov\" (did you mean "
       "\"kacanov\"?)"},
      {"mesh.box.cells[1]=0", "mesh.box.cells[1]: expected a whole number ≥ 1, got 0"},
      {"mesh.box.size[0]=-4", "mesh.box.size[0]: expected a number > 0, got -4"},
      {"mesh.box.element=tri3", "mesh.box.size: expected 2 entries (one a dimension)"},
      {"mesh.box.element=tet5",
       "mesh.box.element: expected \"tri3\", \"tet4\", \"tet10\", \"hex8\" or \"quad4\", got \"tet5\""},
      {"boundary[1].on.box=[[2,0,1],[1,1,1]]",
       "boundary[1].on.box: expected a lower corner that is below the upper one"},
      {"boundary[0].displacement=[null,null,null]",
       "boundary[0].displacement: expected at least one component that is not null"},
      // Missing keys, and one of several alternatives.
      {"boundary[1]={\"traction\":[0,0,1]}", "boundary[1].on: this key is missing"},
      {"boundary[1]={\"on\":\"left\"}",
       "boundary[1]: expected one of the keys displacement, traction, pressure, body_force"},
      {"boundary[1].pressure=1",
       "boundary[1]: expected only one of the keys displacement, traction, pressure, body_force, "
       "total_force, "
       "density, spring, node_spring, node_force, temperature, normal, got "
       "traction and pressure"},
      {"mesh.file=a.msh", "mesh: expected only one of the keys file, files, box, got file and box"},
      {"material[0].law.yield_stress=1",
       "material[0].law: expected only one of the keys x0, yield_stress, got x0 and yield_stress"},
      {"material[0].law={}", "material[0].law.type: this key is missing"},
      {"material[0].law.type=log", "material[0].law.type: expected \"linear\", \"logarithmic\""},
      {"material=[]", "material: expected at least one material, got []"},
      {"contact[0].friction.coulomb=0.3",
       "contact[0].friction: expected only one of the keys tresca, coulomb"},
      {"contact[0].obstacle.gap=0",
       "contact[0].obstacle: expected only one of the keys plane, sphere, cylinder, cone, torus, box, "
       "surface, "
       "height_map, gap, got plane and gap"},
      {"boundary[1].name=", "boundary[1].name: expected a string, got \"\""},
      {"boundary[1].name=boundary[2]",
       "boundary[2].name: expected another name than that of boundary[1], got \"boundary[2]\""},
      {"contact[2].name=contact[0]",
       "contact[2].name: expected another name than that of contact[0], got \"contact[0]\""},
      {"contact[0].name=3", "contact[0].name: expected a string, got 3"},
      {"boundary[3]={\"on\":\"all\",\"density\":1}", "boundary[3].acceleration: this key is missing"},
      {"boundary[3]={\"on\":\"all\",\"density\":0,\"acceleration\":[0,0,1]}",
       "boundary[3].density: expected a number > 0, got 0"},
      {"boundary[3].acceleration=[0,0,-1]",
       "boundary[3].acceleration: expected this key beside density alone"},
      {"boundary[1]={\"on\":\"left\",\"total_force\":3}",
       "boundary[1].total_force: expected a list of 2 or 3 numbers, got 3"},
      // Materials from tension tests.
      {"material[0].plastic=[[250,0]]",
       "material[0]: expected only one of the keys law, plastic, tangent_modulus"},
      {"material[0].yield_stress=1",
       "material[0].yield_stress: expected this key beside tangent_modulus alone"},
      {"material[0].law={\"type\":\"ramberg_osgood\",\"sigma0\":1,\"alpha\":1,\"n\":1}",
       "material[0].law.n: expected a number > 1, got 1"},
      {"material[0].law={\"type\":\"ramberg_osgood\",\"sigma0\":1,\"alpha\":1,\"n\":5,\"argument\":\"norm\"}",
       "material[0].law.argument: unknown key"},
      // Laws.
      {"material[0].law={\"type\":\"linear_hardening\",\"x0\":0.01}",
       "material[0].law.gamma: this key is missing"},
      {"material[0].law={\"type\":\"linear_hardening\",\"x0\":0.01,\"gamma\":0}",
       "material[0].law.gamma: expected a number > 0 and ≤ 1, got 0"},
      {"material[0].law={\"type\":\"power\",\"x0\":0.01,\"n\":1.5}",
       "material[0].law.n: expected a number > 0 and ≤ 1, got 1.5"},
      {"material[0].law={\"type\":\"saturating\",\"x0\":0.01,\"q\":0}",
       "material[0].law.q: expected a number > 0, got 0"},
      {"material[0].law={\"type\":\"table\",\"points\":[[0,0]]}",
       "material[0].law.points: expected a list of pairs [x, s] from [0, 0] on"},
      {"material[0].law={\"type\":\"table\",\"points\":[[0.1,0],[1,1]]}",
       "material[0].law.points[0]: expected [0, 0] as the first point"},
      {"material[0].law={\"type\":\"table\",\"points\":[[0,0],[1,1],[1,2]]}",
       "material[0].law.points[2][0]: expected a strain above that of the point before"},
      {"material[0].law={\"type\":\"table\",\"points\":[[0,0],[1,1],[2,1]]}",
       "material[0].law.points[2][1]: expected a stress above that of the point before"},
      {"material[0].law={\"type\":\"table\",\"points\":[[0,0],[1,1],[2,3]]}",
       "material[0].law.points[2]: expected a secant s/x not above that of the point before"},
      // Combinations that the solver does not offer.
      {"solver.contact=active_set",
       "solver.contact: \"active_set\" together with the stop \"paper\" is not available"},
      {"solver.outer=newton", "solver.outer: \"newton\" together with the stop \"paper\" is not available"},
  };
  for (const Row& row : rows) {
    const std::string message = complaint(row.change);
    INFO("change: ", row.change, "\nmessage: ", message);
    CHECK(message.rfind(row.message, 0) == 0);
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("several mistakes are all said, each once, of ten at most") {
  nlohmann::json document = complete_case();
  for (const char* change :
       {"material[0].youngs=1", "boundary[0].displacement=[\"free\",0,\"free\"]",
        "contact[1].obstacle.sphere.radius=-2", "boundary[1]={\"on\":\"left\",\"tracton\":[0,0,1]}",
        "solver.tolerance=high", "probe=[1,2,3]"})
    apply_override(document, change);
  document["material"][0].erase("young");
  const auto said = [](const nlohmann::json& wrong) {
    try {
      parse_case(wrong, "");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string all = said(document);
  INFO(all);
  CHECK(all.rfind("the case has 7 mistakes:\n  material[0].youngs: unknown key (did you mean \"young\"?)",
                  0) == 0);
  // A misspelt key is not reported as missing too.
  CHECK(all.find("young: this key is missing") == std::string::npos);
  CHECK(all.find("boundary[1]: expected one of") == std::string::npos);
  for (const char* part :
       {"\n  boundary[0].displacement[0]: expected a number, or null for a free component, got \"free\"",
        "\n  boundary[0].displacement[2]: expected a number, or null for a free component, got \"free\"",
        "\n  boundary[1].tracton: unknown key (did you mean \"traction\"?)",
        "\n  contact[1].obstacle.sphere.radius: expected a number > 0, got -2",
        "\n  solver.tolerance: expected a number above 0",
        "\n  probe[0]: expected a list of 2 or 3 numbers, got 1"})
    CHECK(all.find(part) != std::string::npos);
  // Errors that need the whole case.
  document = complete_case();
  apply_override(document, "contact[0].obstacle.plane.normal=[0,0,0]");
  apply_override(document, "contact[0].name=same");
  apply_override(document, "contact[1].name=same");
  CHECK(
      said(document) ==
      "the case has 2 mistakes:\n  contact[0].obstacle.plane.normal: expected a vector that is not zero, got "
      "[0,0,0]\n  contact[1].name: expected another name than that of contact[0], got \"same\"");
  for (int i = 0; i < 14; ++i) document["solver"]["key" + std::to_string(i)] = 1;
  const std::string many = said(document);
  INFO(many);
  CHECK(many.rfind("the case has 14 mistakes, of which the first 10 are:\n", 0) == 0);
  CHECK(std::count(many.begin(), many.end(), '\n') == 10);
  // The message names the file.
  try {
    parse_case(CaseText{"some/beam.json", document.dump()}, {});
    CHECK(false);
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).rfind("some/beam.json has 14 mistakes", 0) == 0);
  }
}

TEST_CASE("mistakes in what a test in tension says") {
  const auto said = [](const std::string& keys) {
    return complaint("material[0]={\"on\":\"all\",\"young\":200,\"poisson\":0.3," + keys + "}");
  };
  CHECK(said("\"plastic\":[[1,0],[2,0.1]]").empty());
  CHECK(said("\"yield_stress\":1,\"tangent_modulus\":2").empty());
  const auto starts = [&](const std::string& keys, const char* message) {
    const std::string found = said(keys);
    INFO(keys, "\n", found);
    CHECK(found.rfind(message, 0) == 0);
  };
  starts("\"plastic\":[]", "material[0].plastic: expected at least one pair [stress, plastic strain]");
  starts("\"plastic\":[3]", "material[0].plastic[0]: expected a pair [stress, plastic strain], got 3");
  starts("\"plastic\":[[0,0]]", "material[0].plastic[0][0]: expected a number > 0, got 0");
  starts("\"plastic\":[[1,0.1]]", "material[0].plastic[0]: expected a first plastic strain of 0");
  starts("\"plastic\":[[1,0],[2,0]]", "material[0].plastic[1]: expected a plastic strain above");
  starts("\"plastic\":[[1,0],[0.9,1]]", "material[0].plastic[1]: expected a stress not below");
  starts("\"plastic\":[[1,0],[1.1,0.1],[2,0.11]]",
         "material[0].plastic[2]: expected a plastic strain over stress");
  starts("\"yield_stress\":1,\"tangent_modulus\":200",
         "material[0].tangent_modulus: expected a number below young");
  starts("\"tangent_modulus\":20", "material[0].yield_stress: this key is missing");
}

TEST_CASE("text that is no JSON is placed by line and column") {
  CHECK(syntax_complaint("{\"mesh\": 3,\n \"material\": }").rfind("beam.json:2:14: not valid JSON: ", 0) ==
        0);
  CHECK(syntax_complaint("{\"a\": NaN}").rfind("beam.json:1:7: not valid JSON: ", 0) == 0);
  CHECK(syntax_complaint("{\n\"a\": 1,\n}").rfind("beam.json:3:1: not valid JSON: ", 0) == 0);
  CHECK(syntax_complaint("{\"a\": [1, 2").rfind("beam.json:1:", 0) == 0);
  CHECK(syntax_complaint("{\"a\": 1} x").rfind("beam.json:1:10: not valid JSON: ", 0) == 0);
  CHECK(syntax_complaint("") == "beam.json: the file is empty, expected a JSON object");
  CHECK(syntax_complaint(" \n ") == "beam.json: the file is empty, expected a JSON object");
  CHECK(syntax_complaint("[1]") == "beam.json: expected a JSON object, got [1]");
  CHECK(syntax_complaint("{\"a\": \"\xff\"}").rfind("beam.json:1:", 0) == 0);
}

TEST_CASE("repeated keys and numbers out of range are named by their path") {
  CHECK(syntax_complaint(R"({"solver": {"r": 1, "r": 2}})") == "solver.r: this key is there twice");
  CHECK(syntax_complaint(R"({"contact": [{}, {"on": "a", "on": "b"}]})") ==
        "contact[1].on: this key is there twice");
  CHECK(syntax_complaint(R"({"a": {"x": 1}, "b": {"x": 1}})").empty());
  CHECK(syntax_complaint(R"({"material": [{"young": 1e999}]})") ==
        "material[0].young: the number 1e999 is too large");
}

TEST_CASE("a case file that is not there or is a folder") {
  const auto reading = [](const char* path) {
    try {
      read_case_text(path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(reading("no/such/case.json") == "no/such/case.json: there is no such file");
  CHECK(reading(".") == ".: this is a folder, expected a case file");
}

TEST_CASE("overrides that lead nowhere") {
  CHECK(complaint("solver.tolerance").rfind("--set: expected key=value such as", 0) == 0);
  CHECK(complaint("=3").rfind("--set: expected key=value", 0) == 0);
  CHECK(complaint("solver..r=3").rfind("--set: expected key=value", 0) == 0);
  CHECK(complaint("contact[x].on=a").rfind("--set: expected key=value", 0) == 0);
  CHECK(complaint("contact[3].on=a") == "--set contact[3].on: contact has 3 entries, counted from 0");
  CHECK(complaint("solver[0]=a") == "--set solver[0]: solver is no list in the case file");
  CHECK(complaint("solver.r.x=a") == "--set solver.r.x: solver.r is no object in the case file");
}

TEST_CASE("vectors fit the dimension of the mesh; a third entry of zero fits a plane one too") {
  const Case solid = parse_case(complete_case(), "");
  CHECK_NOTHROW(check_dimension(solid, 3));
  CHECK_THROWS_WITH_AS(
      check_dimension(solid, 2),
      doctest::Contains(
          "\n  boundary[1].on.box[0]: expected 2 entries, as the mesh has 2 dimensions, got 3\n"),
      InputError);
  nlohmann::json document = complete_case();
  apply_override(
      document, "boundary=[{\"on\":\"left\",\"displacement\":[0,0]},{\"on\":\"top\",\"traction\":[0,-1,0]}]");
  apply_override(document, "contact=[]");
  apply_override(document, "probe=[[4,1]]");
  const Case flat = parse_case(document, "");
  CHECK_NOTHROW(check_dimension(flat, 2));
  CHECK_THROWS_WITH_AS(
      check_dimension(flat, 3),
      doctest::Contains(
          "\n  boundary[0].displacement: expected 3 entries, as the mesh has 3 dimensions, got 2\n"),
      InputError);
}
