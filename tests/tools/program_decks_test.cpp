// SPDX-License-Identifier: BSD-3-Clause
// Whole decks as cases, conversions of meshes between formats, and templates of cases.
#include <doctest/doctest.h>

#include "verified_run.hpp"

using namespace kacanov::testing;

namespace {

/// A bar of 2 × 1 × 1 of two cubes along x; each test adds what follows the elements.
const std::string bar_nodes =
    "*HEADING\nBar in tension\n*NODE, "
    "NSET=Nall\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,1,0\n5,1,1,0\n6,2,1,0\n7,0,0,1\n"
    "8,1,0,1\n9,2,0,1\n10,0,1,1\n11,1,1,1\n12,2,1,1\n*ELEMENT, TYPE=C3D8, ELSET=Bar\n"
    "1, 1,2,5,4,7,8,11,10\n2, 2,3,6,5,8,9,12,11\n*NSET, NSET=Left\n1,4,7,10\n*NSET, NSET=Right\n3,6,9,12\n";
/// Supports that allow lateral contraction.
const std::string held = "*BOUNDARY\nLeft, 1\n1, 2, 3\n7, 2\n4, 3\n";
const std::string steel = "*MATERIAL, NAME=Steel\n*ELASTIC\n200000., 0.3\n";
const std::string section = "*SOLID SECTION, ELSET=Bar, MATERIAL=STEEL\n";

/// Returns the result of a deck, solved and verified by the program's own verifier in the folder of `place`.
nlohmann::json solved_deck(const Workplace& place, const std::string& deck, const std::string& more = "") {
  place.put("deck.inp", deck);
  const Outcome made = place.run("convert deck.inp --force");
  INFO(made.error);
  REQUIRE(made.exit_code == 0);
  const std::string set = " --set 'probe=[[2,0.5,0.5],[1,1,1]]' --set solver.tolerance=1e-10 " + more;
  const Outcome run = place.run("run deck.json --output out" + set);
  INFO(run.error);
  REQUIRE(run.exit_code == 0);
  const Outcome verified = place.run("verify deck.json --output out" + set);
  INFO(verified.error, verified.output);
  CHECK(verified.exit_code == 0);
  return place.json("out/result.json");
}

void check_deck_refused(const std::string& deck, const std::string& message) {
  const Workplace place;
  place.put("deck.inp", deck);
  const Outcome refused = place.run("convert deck.inp");
  CHECK(refused.exit_code == 2);
  INFO(refused.error);
  CHECK(refused.error.find(message) != std::string::npos);
  CHECK(!place.has("deck.json"));
  CHECK(!place.has("deck.msh"));
}

}  // namespace

TEST_CASE(
    "a deck of a bar in tension: forces at nodes, a pressure on sides, and a displacement come to the same") {
  const double stress = 100.0, strain = stress / 200000.0;
  for (const char* load :
       {"*CLOAD\nRight, 1, 20.\nRight, 1, 5.\n", "*DLOAD\n2, P4, -100.\n",
        "*DLOAD\n2, P4, -60.\n*DSLOAD\nEnd, P, -40.\n", "*BOUNDARY\nRight, 1, 1, 1.e-3\n"}) {
    const Workplace place;
    const nlohmann::json result =
        solved_deck(place, bar_nodes + "*SURFACE, NAME=End\n2, S4\n" + held + steel + section +
                               "*STEP\n*STATIC\n" + load + "*END STEP\n");
    INFO(load);
    CHECK(result["probe"][0][0].get<double>() == doctest::Approx(2 * strain).epsilon(1e-9));
    CHECK(result["probe"][1][1].get<double>() == doctest::Approx(-0.3 * strain).epsilon(1e-9));
    CHECK(result["max_von_mises"].get<double>() == doctest::Approx(stress).epsilon(1e-9));
    CHECK(result["case"]["title"] == "Bar in tension");
  }
}

TEST_CASE("a deck is run at once, to the numbers of the case that convert makes of it") {
  const Workplace place;
  const std::string deck = bar_nodes + held + steel + section +
                           "*STEP\n*STATIC\n*CLOAD\nRight, 1, 25.\n*NODE FILE\nU\n*END STEP\n";
  const nlohmann::json expected = solved_deck(place, deck);
  for (const char* ranks : {"", " --ranks 2"}) {
    const Outcome run = place.run("run deck.inp --set solver.tolerance=1e-10" + std::string(ranks));
    INFO(run.error);
    REQUIRE(run.exit_code == 0);
    CHECK(run.error.find("warning: deck.inp: line 36: *NODE FILE is left out") != std::string::npos);
    const nlohmann::json result = place.json("results/deck/result.json");
    CHECK(result["max_displacement"]["value"].get<double>() ==
          doctest::Approx(expected["max_displacement"]["value"].get<double>()).epsilon(1e-9));
    CHECK(place.run("verify results/deck/deck.json --output results/deck").exit_code == 0);
  }
  REQUIRE(place.run("run deck.inp --output elsewhere --quiet").exit_code == 0);
  CHECK(place.has("elsewhere/deck.msh"));
  place.put("deck.inp", deck + "*STEP\n*STATIC\n*END STEP\n");
  const Outcome refused = place.run("run deck.inp --output elsewhere");
  CHECK(refused.exit_code == 2);
  CHECK(refused.error.find("deck.inp: line 39: a second step") != std::string::npos);
  place.put("deck.inp", deck + "*STEP\n*HEAT TRANSFER\n");
  CHECK(place.run("run deck.inp --leave-out").exit_code == 2);  // two load steps, whatever is omitted
  place.put("result.inp", deck);
  CHECK(place.run("run result.inp").error.find("expected another name") != std::string::npos);
}

TEST_CASE("the curve of *PLASTIC is that of a bar in tension") {
  const Workplace place;
  const double stress = 300.0, strain = stress / 200000.0 + 0.005;  // half-way between 250 and 350
  const nlohmann::json result =
      solved_deck(place, bar_nodes + held + steel + "*PLASTIC\n250., 0.\n350., 0.01\n" + section +
                             "*STEP\n*STATIC\n0.1, 1.\n*CLOAD\nRight, 1, 75.\n*NODE FILE\nU\n*END STEP\n");
  CHECK(result["probe"][0][0].get<double>() == doctest::Approx(2 * strain).epsilon(1e-8));
  CHECK(result["max_von_mises"].get<double>() == doctest::Approx(stress).epsilon(1e-8));
  const std::string text = contents(place.path("deck.json"));
  CHECK(text.find("// deck.inp: line 40: *NODE FILE is left out, which does not change the answer\n") !=
        std::string::npos);
}

TEST_CASE("sets of elements and of nodes that have one name are told apart") {
  const Workplace place;
  const std::string deck = bar_nodes + held + steel +
                           "*ELSET, ELSET=Left\n1\n*ELSET, ELSET=Right\n2\n*SOLID SECTION, "
                           "ELSET=Left, MATERIAL=Steel\n*SOLID SECTION, ELSET=Right, MATERIAL=Steel\n"
                           "*STEP\n*STATIC\n*CLOAD\nRight, 1, 25.\n*END STEP\n";
  const nlohmann::json result = solved_deck(place, deck);
  CHECK(result["probe"][0][0].get<double>() == doctest::Approx(1e-3).epsilon(1e-9));
  CHECK(result["case"]["material"][0]["on"] == "elements_1");
}

TEST_CASE(
    "gravity of two materials, by the density of each, and a step's displacement in place of the model's") {
  const Workplace place;
  const nlohmann::json result = solved_deck(
      place, bar_nodes +
                 "*ELSET, ELSET=A\n1\n*ELSET, ELSET=B\n2\n*BOUNDARY\nNall, 2, 3\nLeft, XSYMM\nRight, 1\n" +
                 steel +
                 "*DENSITY\n2.\n*MATERIAL, NAME=Lead\n*ELASTIC\n200000., 0.3\n*DENSITY\n10.\n*SOLID SECTION, "
                 "ELSET=A, "
                 "MATERIAL=Steel\n*SOLID SECTION, ELSET=B, MATERIAL=lead\n*STEP\n*STATIC\n*DLOAD\nBar, GRAV, "
                 "100., 2., 0., "
                 "0.\n*BOUNDARY\nRight, 1, 1, 1e-3\n*END STEP\n");
  double load = 0.0;
  for (const auto& entry : result["load"]) load += entry["force"][0].get<double>();
  CHECK(load == doctest::Approx(1200.0));
  CHECK(result["probe"][0][0].get<double>() == doctest::Approx(1e-3));
}

TEST_CASE("what cannot be part of a case is refused with file and line, and left out only when told to") {
  const std::string step = "*STEP\n*STATIC\n*CLOAD\nRight, 1, 25.\n*END STEP\n";
  check_deck_refused(bar_nodes + held + steel + section,
                     "deck.inp: expected a step, *STEP: this deck is a mesh alone");
  check_deck_refused(bar_nodes + held + steel + step, "deck.inp: expected a *SOLID SECTION");
  check_deck_refused(bar_nodes + held + section + step, "there is no material \"STEEL\"");
  check_deck_refused(bar_nodes + held + steel + "*SOLID SECTION, ELSET=Rod, MATERIAL=Steel\n" + step,
                     "deck.inp: line 31: there is no set of elements \"Rod\"");
  check_deck_refused(bar_nodes + held + "*MATERIAL, NAME=S\n*ELASTIC, TYPE=ORTHO\n1,2,3\n" + step,
                     "deck.inp: line 29: *ELASTIC: expected an isotropic material, got TYPE=ORTHO");
  check_deck_refused(
      bar_nodes + held + steel + "210000., 0.3, 100.\n" + step,
      "deck.inp: line 31: expected one Young's modulus and Poisson's ratio, at all temperatures");
  check_deck_refused(bar_nodes + held + steel + section + step + step,
                     "a second step: expected a deck of one");
  check_deck_refused(
      bar_nodes + held + steel + section + "*STEP, NLGEOM\n*STATIC\n*END STEP\n",
      "deck.inp: line 32: *STEP changes the answer: NLGEOM: displacements and rotations have to be small");
  check_deck_refused(bar_nodes + held + steel + section + "*STEP\n*STATIC\n*CLOAD\nRight, 4, 1.\n*END STEP\n",
                     "deck.inp: line 35: expected a degree of freedom 1 to 3, got 4");
  check_deck_refused(
      bar_nodes + held + steel + section + "*STEP\n*STATIC\n*DLOAD\nBar, P4, 1.\n*END STEP\n",
      "deck.inp: line 35: 1 of these sides are inside the body, expected sides of its boundary");
  check_deck_refused(
      bar_nodes + held + steel + section + "*STEP\n*STATIC\n*DLOAD\nBar, GRAV, 1., 0, 0, 1\n*END STEP\n",
      "deck.inp: line 35: GRAV: the material \"Steel\" has no *DENSITY > 0");
  check_deck_refused(bar_nodes + held + steel + "*PLASTIC\n250., 0.\n200., 0.1\n" + section + step,
                     "deck.inp: line 33: material[0].plastic[1]: expected a stress not below");
  const std::string contact =
      bar_nodes + held + steel + section + "*CONTACT PAIR, INTERACTION=I\nA, B\n" + step;
  check_deck_refused(
      contact, "deck.inp: line 32: *CONTACT PAIR changes the answer: it is not known here; --leave-out");
  const Workplace place;
  place.put("deck.inp", contact);
  const Outcome left_out = place.run("convert deck.inp part.json --leave-out");
  CHECK(left_out.exit_code == 0);
  CHECK(left_out.error.find("warning: deck.inp: line 32: LEFT OUT: *CONTACT PAIR changes the answer") !=
        std::string::npos);
  CHECK(contents(place.path("part.json")).find("// deck.inp: line 32: LEFT OUT: *CONTACT PAIR") !=
        std::string::npos);
  CHECK(place.run("convert deck.inp part.json --leave-out")
            .error.find("part.json: there is such a file already") != std::string::npos);
}

TEST_CASE(
    "decks of plane stress, plane strain and round an axis: the plane, the thickness, forces of all of it") {
  // 2 × 1, two squares, thickness 3, with supports that allow lateral contraction.
  const auto flat = [](const std::string& type) {
    return "*NODE\n1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n*ELEMENT, TYPE=" + type +
           ", ELSET=Bar\n1,1,2,5,4\n2,2,3,6,5\n*NSET, NSET=Left\n1,4\n*NSET, NSET=Lower\n1,2,3\n" + steel +
           "*SOLID SECTION, ELSET=Bar, MATERIAL=STEEL\n3.\n*STEP\n*STATIC\n";
  };
  const std::string points = " --set 'probe=[[2,1]]'";
  for (const std::string type : {"CPS4", "CPS4R", "CPE4"}) {
    const Workplace place;
    const nlohmann::json result = solved_deck(
        place, flat(type) + "*BOUNDARY\nLeft, 1\n1, 2\n*CLOAD\n3, 1, 150.\n6, 1, 150.\n*END STEP\n", points);
    CAPTURE(type);
    const bool free_across = type[2] == 'S';
    CHECK(result["case"].value("plane", "strain") == (free_across ? "stress" : "strain"));
    CHECK(result["case"]["thickness"] == 3.0);
    CHECK(result["mesh"]["volume"].get<double>() == doctest::Approx(6.0));
    CHECK(result["probe"][0][0].get<double>() ==
          doctest::Approx(2 * 100 / 200000.0 * (free_across ? 1 : 1 - 0.09)).epsilon(1e-9));
    CHECK(result["probe"][0][1].get<double>() ==
          doctest::Approx(-0.3 * 100 / 200000.0 * (free_across ? 1 : 1.3)).epsilon(1e-9));
    double reaction = 0.0, load = 0.0;
    for (const auto& entry : result["reaction"]) reaction += entry["force"][0].get<double>();
    for (const auto& entry : result["load"]) load += entry["force"][0].get<double>();
    CHECK(reaction == doctest::Approx(-300.0).epsilon(1e-8));
    CHECK(load == doctest::Approx(300.0));
  }
  for (const std::string type : {"CAX4", "CAX4R"}) {
    const Workplace place;
    const nlohmann::json result =
        solved_deck(place, flat(type) + "*BOUNDARY\nLower, 2\n*DLOAD\nBar, P3, 50.\n*END STEP\n", points);
    CHECK(result["case"]["plane"] == "axisymmetric");
    CHECK(!result["case"].contains("thickness"));
    CHECK(result["probe"][0][1].get<double>() == doctest::Approx(-50 / 200000.0).epsilon(1e-9));
    CHECK(result["probe"][0][0].get<double>() == doctest::Approx(2 * 0.3 * 50 / 200000.0).epsilon(1e-9));
    double load = 0.0;
    for (const auto& entry : result["load"]) load += entry["force"][1].get<double>();
    CHECK(load == doctest::Approx(-50 * 4 * 3.14159265358979));
  }
}

TEST_CASE("a deck's temperatures: what the nodes are warmer by than at the start") {
  const std::string held_all = "*BOUNDARY\nNall, 1, 3\n", step = "*STEP\n*STATIC\n";
  const std::string warm_steel = steel + "*EXPANSION, ZERO=20.\n1.2e-5\n";
  const double pressure = 200000 * 1.2e-5 * 100 / (1 - 2 * 0.3);
  {
    const Workplace place;
    const nlohmann::json result =
        solved_deck(place, bar_nodes + held_all + warm_steel + section +
                               "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNall, 20.\n" + step +
                               "*TEMPERATURE\nNall, 120.\n*END STEP\n");
    CHECK(result["case"]["boundary"].back()["temperature"] == 100.0);
    CHECK(result["max_von_mises"].get<double>() < 1e-9 * pressure);
    CHECK(!place.has("deck.temperature.csv"));
  }
  const Workplace place;
  const nlohmann::json result =
      solved_deck(place, bar_nodes + held_all + warm_steel + section +
                             "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNall, 20.\n" + step +
                             "*TEMPERATURE\nNall, 70.\nRight, 270.\nLeft, 20.\n*END STEP\n");
  CHECK(contents(place.path("deck.temperature.csv")).find("\n2, 50\n3, 250\n") != std::string::npos);
  // 0, 50 and 250 at the nodes: the warmer element's mean is 150, and nothing moves.
  CHECK(result["max_von_mises"].get<double>() < 1e-9 * pressure);
  const Outcome again = place.run("run deck.inp --output at_once --set solver.tolerance=1e-10");
  INFO(again.error);
  CHECK(again.exit_code == 0);
  CHECK(place.run("verify at_once/deck.json --output at_once --set solver.tolerance=1e-10").exit_code == 0);
  CHECK(place.json("at_once/result.json")["reaction"] == place.json("out/result.json")["reaction"]);
  check_deck_refused(
      bar_nodes + held_all + steel + "*EXPANSION\n1e-5, 0.\n2e-5, 100.\n" + section + step + "*END STEP\n",
      "expected one coefficient of expansion, at all temperatures");
  check_deck_refused(bar_nodes + held_all + steel + "*EXPANSION, TYPE=ORTHO\n1e-5, 1e-5, 1e-5\n" + section +
                         step + "*END STEP\n",
                     "*EXPANSION: expected an isotropic material, got TYPE=ORTHO");
  check_deck_refused(
      bar_nodes + held_all + warm_steel + section + step + "*TEMPERATURE, FILE=heat\n*END STEP\n",
      "*TEMPERATURE changes the answer: FILE=heat is not known here");
  check_deck_refused(
      bar_nodes + held_all + warm_steel + section + step + "*TEMPERATURE\nNowhere, 3.\n*END STEP\n",
      "there is no set of nodes \"Nowhere\"");
  check_deck_refused(bar_nodes + held_all + warm_steel + section +
                         "*INITIAL CONDITIONS, TYPE=STRESS\nBar, 3.\n" + step + "*END STEP\n",
                     "*INITIAL CONDITIONS changes the answer: it is not known here, but TYPE=TEMPERATURE");
}

TEST_CASE("meshes keep their groups and numbers from one format to another") {
  const Workplace place;
  place.put("a.inp", bar_nodes + "*SURFACE, NAME=End\n2, S4\n*ELSET, ELSET=Half way\n2\n");
  for (const char* step :
       {"convert a.inp b.msh", "convert b.msh c.inp", "convert c.inp d.msh", "convert d.msh e.vtu"}) {
    const Outcome outcome = place.run(step);
    INFO(step, outcome.error);
    CHECK(outcome.exit_code == 0);
  }
  CHECK(contents(place.path("b.msh")) == contents(place.path("d.msh")));
  CHECK(place.run("check a.inp").error.find("a.inp: this is a deck, expected a case; kacanov convert") !=
        std::string::npos);
  CHECK(place.run("run b.msh").error.find("b.msh: this is a mesh, expected a case; kacanov init") !=
        std::string::npos);
  place.put("part.geo", "// a block\nSetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n");
  CHECK(place.run("run part.geo").error.find("part.geo: this is a geometry, expected a case: gmsh -3") !=
        std::string::npos);
  CHECK(place.run("init part.geo").error.find("part.geo: this is a geometry, not yet a mesh: gmsh -3") !=
        std::string::npos);
  CHECK(contents(place.path("c.inp")).find("\"Half way\"") != std::string::npos);
  CHECK(place.has("e.vtu"));
  CHECK(place.run("convert a.inp a.stl")
            .error.find("expected a name that ends with .json, .msh, .inp or .vtu") != std::string::npos);
  CHECK(place.run("convert b.msh f.json").error.find("kacanov init writes one for a mesh") !=
        std::string::npos);
}

TEST_CASE("a deck is a mesh of a case, with sets and surfaces as groups") {
  const Workplace place;
  place.put("bar.inp", bar_nodes + "*SURFACE, NAME=End\n2, S4\n" + steel);
  place.put_json("case.json", parsed(R"({"mesh": {"file": "bar.inp"},
    "material": [{"on": "Bar", "young": 200000, "poisson": 0}],
    "boundary": [{"on": "Left", "displacement": [0, 0, 0]}, {"on": "End", "traction": [100, 0, 0]}],
    "probe": [[2, 0, 0]]})"));
  const Outcome run = place.run("run case.json --output out");
  INFO(run.error);
  CHECK(run.exit_code == 0);
  CHECK(place.json("out/result.json")["probe"][0][0].get<double>() == doctest::Approx(1e-3));
  CHECK(run.error.find("left out what is none: *MATERIAL (line 25), *ELASTIC (line 26)") !=
        std::string::npos);
  CHECK(place.run("verify case.json --output out").error.find("kacanov convert makes one of it") !=
        std::string::npos);
}

TEST_CASE("a case to start from is one, with comments") {
  const Workplace place;
  place.put("bar.inp", bar_nodes + "*SURFACE, NAME=End\n2, S4\n*SURFACE, NAME=\"Far // end\"\n1, S6\n");
  const Outcome made = place.run("init bar.inp");
  INFO(made.error);
  REQUIRE(made.exit_code == 0);
  CHECK(contents(place.path("bar.json")).find("// groups of facets: \"End\" (1), \"Far // end\" (1)\n") !=
        std::string::npos);
  for (const char* command : {"check bar.json", "run bar.json --output out"}) {
    const Outcome outcome = place.run(command);
    INFO(outcome.error);
    CHECK(outcome.exit_code == 0);
  }
  CHECK(place.json("out/result.json")["case"]["title"] == "bar");
  CHECK(place.run("init bar.inp").error.find("bar.json: there is such a file already; --force") !=
        std::string::npos);
  CHECK(place.run("init bar.inp --force").exit_code == 0);
  place.run("convert bar.inp plain.msh");
  CHECK(place.run("init plain.msh sub/plain.json").exit_code != 0);
}

TEST_CASE("comments, $schema and a title are accepted in a case") {
  const Workplace place;
  place.put("beam.json", "// what it is\n{\"$schema\": \"x\", \"title\": \"A beam\", /* the rest */" +
                             small_beam().dump().substr(1) + "// end\n");
  const Outcome run = place.run("run beam.json --output out");
  INFO(run.error);
  CHECK(run.exit_code == 0);
  CHECK(place.run("verify beam.json --output out").exit_code == 0);
  CHECK(place.run("check beam.json --set title=3").error.find("title: expected a string") !=
        std::string::npos);
  place.put("open.json", "{ /* never closed");
  CHECK(place.run("check open.json").error.find("open.json:1:") != std::string::npos);
}

TEST_CASE("the fields of a run are a mesh for another") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  place.put_json("beam.json", beam);
  REQUIRE(place.run("run beam.json --output out --ranks 1").exit_code == 0);
  beam["mesh"] = {{"file", "out/body.vtu"}};
  beam["boundary"][0]["on"] = parsed(R"({"box": [[0, 0], [0, 1]]})");
  beam["contact"][0]["on"] = parsed(R"({"box": [[0, 0], [4, 0]]})");
  place.put_json("again.json", beam);
  const Outcome again = place.run("run again.json --output again");
  INFO(again.error);
  REQUIRE(again.exit_code == 0);
  CHECK(place.json("again/result.json")["probe"] == place.json("out/result.json")["probe"]);
}
