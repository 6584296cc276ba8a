// SPDX-License-Identifier: BSD-3-Clause
// Text files of every kind: encodings, line ends, control characters for terminals, files of other kinds.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "verified_run.hpp"

using namespace kacanov::testing;

namespace {

/// A unit cube with E = 1000, ν = 0.25, fixed at its bottom, with −2.5 at each of its upper nodes.
const std::string cube_mesh =
    "*NODE,NSET=NALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
    "*ELEMENT,TYPE=C3D8,ELSET=E\n1,1,2,3,4,5,6,7,8\n*NSET,NSET=BOT\n1,2,3,4\n*NSET,NSET=TOP\n5,6,7,8\n";
const std::string cube_material =
    "*MATERIAL,NAME=M\n*ELASTIC\n1000,0.25\n*SOLID SECTION,ELSET=E,MATERIAL=M\n";
const std::string cube_step = "*STEP\n*STATIC\n*BOUNDARY\nBOT,1,3\n*CLOAD\nTOP,3,-2.5\n*END STEP\n";
const std::string cube = cube_mesh + cube_material + cube_step;
/// Its largest displacement: 1/600 outwards twice, 17/1800 down, as computed by CalculiX to seven digits.
const double sunk = std::sqrt(307.0) / 1800;

const std::string cube_msh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n$EndPhysicalNames\n$Nodes\n8\n1 "
    "0 0 0\n2 1 0 "
    "0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 "
    "7 8\n"
    "$EndElements\n";
const char* const cube_case =
    R"({"mesh": {"file": "cube.msh"}, "material": [{"on": "all", "young": 1000, "poisson": 0.25}],
    "boundary": [{"on": {"box": [[0, 0, 0], [1, 1, 0]]}, "displacement": [0, 0, 0]},
                 {"on": {"box": [[0, 0, 1], [1, 1, 1]]}, "node_force": [0, 0, -2.5]}]})";

/// Replaces every line end by a carriage return.
std::string with_returns(std::string text) {
  std::replace(text.begin(), text.end(), '\n', '\r');
  return text;
}

std::string with_mark(const std::string& text) { return "\xef\xbb\xbf" + text; }

/// Encodes ASCII text as UTF-16 in either byte order.
std::string wide(const std::string& text, bool mark, bool big) {
  std::string result = mark ? big ? "\xfe\xff" : "\xff\xfe" : "";
  for (const char c : text) result += big ? std::string{'\0', c} : std::string{c, '\0'};
  return result;
}

double sunk_of(const Workplace& place, const std::string& command, const std::string& folder) {
  const Outcome run = place.run(command + " --set solver.tolerance=1e-10 --ranks 1");
  INFO(run.error);
  REQUIRE(run.exit_code == 0);
  return place.json(folder + "/result.json")["max_displacement"]["value"].get<double>();
}

/// Returns whether a terminal would show the text unchanged.
bool is_tame(const std::string& text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == 0x7f; }) &&
         text.find("\xc2\x9b") == std::string::npos && text.find("\xe2\x80\xae") == std::string::npos;
}

}  // namespace

TEST_CASE(
    "decks with a byte order mark, lone carriage returns or bytes of another encoding are what they are "
    "without") {
  for (const std::string& deck :
       {with_mark(cube), with_returns(cube), with_mark(with_returns(cube)), "*HEADING\nTr\xe4ger\n" + cube,
        "*HEADING\n" + std::string(199, 'x') + "\xc3\xa4\n" + cube}) {
    const Workplace place;
    place.put("cube.inp", deck);
    CHECK(sunk_of(place, "run cube.inp --output out", "out") == doctest::Approx(sunk).epsilon(1e-8));
  }
  const Workplace place;
  place.put("nodes.inp", with_mark(with_returns(cube_mesh)));
  place.put("cube.inp", "*INCLUDE, INPUT=nodes.inp,\n" + cube_material + cube_step);
  CHECK(sunk_of(place, "run cube.inp --output out", "out") == doctest::Approx(sunk).epsilon(1e-8));
}

TEST_CASE("meshes and cases of any line ends, with a byte order mark, are read and verified") {
  for (const bool mark : {true, false}) {
    const auto changed = [&](const std::string& text) { return mark ? with_mark(text) : with_returns(text); };
    const Workplace place;
    place.put("cube.msh", changed(cube_msh));
    place.put("cube.json", changed(cube_case));
    CHECK(sunk_of(place, "run cube.json --output out", "out") == doctest::Approx(sunk).epsilon(1e-8));
    const Outcome verified = place.run("verify cube.json --output out --set solver.tolerance=1e-10");
    INFO(verified.error, verified.output);
    CHECK(verified.exit_code == 0);
    // Two heights per line, two lines; two temperatures; a triangle.
    place.put("heights.csv", changed("2,2\n2,2\n"));
    place.put("warm.csv", changed("1, 10\n2, 20\n3, 10\n4, 10\n5, 10\n6, 10\n7, 10\n8, 10\n"));
    place.put(
        "floor.stl",
        changed("solid a\nfacet normal -1 0 0\nouter loop\nvertex 2 -9 -9\nvertex 2 0 9\nvertex 2 9 -9\n"
                "endloop\nendfacet\nendsolid a\n"));
    const std::string more =
        R"( --set 'contact=[{"on":{"box":[[0,0,1],[1,1,1]]},"obstacle":{"height_map":{"file":"heights.csv",)"
        R"("body":"below","lower":[-2,-2],"upper":[3,3]}}},)"
        R"({"on":{"box":[[1,0,0],[1,1,1]]},"obstacle":{"surface":{"file":"floor.stl"}}}]')"
        R"( --set 'material[0].expansion=1e-5' --set 'boundary=[{"on":{"box":[[0,0,0],[1,1,0]]},"displacement":[0,0,0]},)"
        R"({"on":"all","temperature":{"file":"warm.csv"}}]')";
    const Outcome run = place.run("run cube.json --output warm" + more);
    INFO(run.error);
    CHECK(run.exit_code == 0);
    const Outcome again = place.run("verify cube.json --output warm" + more);
    INFO(again.error, again.output);
    CHECK(again.exit_code == 0);
  }
}

TEST_CASE("text in UTF-16 is named") {
  const Workplace place;
  const auto refused = [&](const std::string& command, const std::string& words) {
    const Outcome outcome = place.run(command);
    INFO(outcome.error);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find(words) != std::string::npos);
  };
  for (const bool mark : {true, false})
    for (const bool big : {true, false}) {
      place.put("cube.inp", wide(cube, mark, big));
      place.put("wide.json", wide(cube_case, mark, big));
      place.put("cube.msh", wide(cube_msh, mark, big));
      place.put("cube.json", cube_case);
      refused("convert cube.inp a.json", "cube.inp: the text is in UTF-16, expected UTF-8");
      refused("run wide.json", "wide.json: the text is in UTF-16, expected UTF-8");
      refused("run cube.json", "cube.msh: the text is in UTF-16, expected UTF-8");
      place.put("part.inp", wide(cube_mesh, mark, big));
      place.put("whole.inp", "*INCLUDE, INPUT=part.inp\n" + cube_material + cube_step);
      refused("convert whole.inp a.json", "part.inp: the text is in UTF-16, expected UTF-8");
    }
}

TEST_CASE("names of files that are no UTF-8 end in words") {
  const Workplace place;
  place.put("tr\xe4ger.inp", cube);
  place.put("tr\xe4ger.msh", cube_msh);
  place.put("cube.msh", cube_msh);
  place.put("tr\xe4ger.json", cube_case);
  place.put("cube.json", cube_case);
  for (const char* command :
       {"init tr\xe4ger.msh a.json", "run tr\xe4ger.inp", "check cube.json --set title=tr\xe4ger",
        "check tr\xe4ger.json --set mesh.file=tr\xe4ger.msh"}) {
    const Outcome outcome = place.run(command);
    INFO(command, outcome.error);
    CHECK(outcome.exit_code == 2);
  }
  for (const char* command :
       {"run tr\xe4ger.json --ranks 1 --output a",
        "run tr\xe4ger.json --ranks 2 --output tr\xe4ger "
        "--set 'mesh={\"box\":{\"size\":[1,1,1],\"cells\":[2,2,2],\"element\":\"hex8\"}}'"})
    CHECK(place.run(command).exit_code == 0);
}

TEST_CASE("names that a terminal would obey are refused, and reach no file and no terminal") {
  for (const char* name : {"\x1b[2J", "\a",
                           "\xc2\x9b"
                           "31m",
                           "\xe2\x80\xae", "a\nb", "\x7f"}) {
    const Workplace place;
    place.put("cube.msh", cube_msh);
    for (const char* key : {"/boundary/0/name", "/boundary/0/on", "/title", "/mesh/file"}) {
      nlohmann::json input = parsed(cube_case);
      input[nlohmann::json::json_pointer(key)] = name;
      place.put_json("case.json", input);
      const Outcome run = place.run("run case.json --output out");
      INFO(key, run.error);
      CHECK(is_tame(run.error));
      CHECK(is_tame(run.printed));
      if (std::string(name) == "a\nb" && std::string(key) == "/title") continue;
      CHECK(run.exit_code == 2);
      CHECK(run.error.find("without control characters") != std::string::npos);
    }
  }
  const Workplace place;
  place.put("cube.msh", cube_msh);
  nlohmann::json input = parsed(cube_case);
  input["boundary"][0]["name"] = std::string("a\0b", 3);
  place.put_json("case.json", input);
  CHECK(place.run("run case.json").error.find("boundary[0].name: expected a string in UTF-8 on one line") !=
        std::string::npos);
  input["boundary"][0]["name"] = "Fuß ↓";  // printable characters
  place.put_json("case.json", input);
  CHECK(place.run("run case.json --output out").exit_code == 0);
}

TEST_CASE("messages show no words of files outside of the case's folder") {
  const Workplace place;
  const std::string secret = "rosebud";
  std::filesystem::create_directories(place.path("secret"));
  std::filesystem::create_directories(place.path("case"));
  for (const char* start :
       {"", "1,", "$", "*", "<", "solid ", "$MeshFormat\n", "*NODE\n", "*NODE\n1,", "*NODE,", "*NSET,NSET="})
    for (const char* path : {"../secret/file", "link", "absolute"}) {
      if (*start != '\0' && path != std::string("../secret/file")) continue;
      place.put("secret/file", start + secret + ":x:0\n" + secret + "\n");
      std::error_code error;
      std::filesystem::remove(place.path("case/link"), error);
      std::filesystem::create_symlink("../secret/file", place.path("case/link"));
      const std::string file = path == std::string("absolute") ? place.path("secret/file").string() : path;
      place.put("case/cube.msh", cube_msh);
      place.put("case/cube.json", cube_case);
      place.put("case/cube.inp",
                cube_mesh + "*NSET,NSET=MORE\n*INCLUDE,INPUT=" + file + "\n" + cube_material + cube_step);
      const std::string contact = R"( --set 'contact=[{"on":{"box":[[0,0,0],[1,1,0]]},"obstacle":)";
      for (const std::string& command : std::initializer_list<std::string>{
               "convert case/cube.inp a.json", "check case/cube.json --set 'mesh.file=" + file + "'",
               R"(check case/cube.json --set 'boundary[1]={"on":"all","temperature":{"file":")" + file +
                   R"("}}')",
               "check case/cube.json" + contact + R"({"surface":{"file":")" + file + R"("}}}]')",
               "check case/cube.json" + contact + R"({"height_map":{"lower":[0,0],"upper":[1,1],"file":")" +
                   file + R"("}}}]')"}) {
        const Outcome outcome = place.run(command + " ");
        INFO(start, command, outcome.error);
        CHECK(outcome.exit_code == 2);
        CHECK(outcome.error.find(std::filesystem::path(file).filename().string()) != std::string::npos);
        for (const std::string& word : {secret, std::string("ROSEBUD")})
          CHECK((outcome.error + outcome.output).find(word) == std::string::npos);
      }
    }
  // The message quotes words of files inside the folder only.
  place.put("case/heights.csv", "1,2\n3,four\n");
  place.put("case/more.inp", "four\n");
  place.put("case/cube.inp",
            cube_mesh + "*NSET,NSET=MORE\n*INCLUDE,INPUT=more.inp\n" + cube_material + cube_step);
  CHECK(place.run("convert case/cube.inp a.json")
            .error.find("more.inp: line 1: there is no set of nodes \"four\"") != std::string::npos);
}

TEST_CASE("where convert cannot write all of its files it leaves none") {
  const Workplace place;
  place.put("cube.inp", cube);
  std::filesystem::create_directories(place.path("cube.json/in the way"));
  CHECK(place.run("convert cube.inp --force").exit_code != 0);
  CHECK(!place.has("cube.msh"));
  place.put("bad.inp", cube + "*CLOAD\nTOP,3,1\n");
  CHECK(place.run("convert bad.inp").exit_code == 2);
  CHECK(!place.has("bad.json"));
  CHECK(!place.has("bad.msh"));
  CHECK(place.run("run bad.inp --output nowhere").exit_code == 2);
  CHECK(!place.has("nowhere"));
}

TEST_CASE("plastic strains above 1 are asked about, in cases and with the line in decks") {
  const Workplace place;
  place.put("cube.msh", cube_msh);
  nlohmann::json input = parsed(cube_case);
  const auto asks = [&](const std::string& command) {
    const Outcome outcome = place.run(command);
    INFO(outcome.error);
    CHECK(outcome.exit_code == 0);
    return outcome.error;
  };
  const std::string words = "strains above 1, up to 10: are they per cent?";
  input["material"][0]["plastic"] = parsed("[[250, 0], [300, 1], [400, 10]]");
  place.put_json("case.json", input);
  CHECK(asks("check case.json").find("material[0].plastic: " + words) != std::string::npos);
  CHECK(asks("run case.json --output out").find(words) != std::string::npos);
  input["material"][0]["plastic"] = parsed("[[250, 0], [300, 0.01], [400, 1]]");
  place.put_json("case.json", input);
  CHECK(asks("check case.json").find("per cent") == std::string::npos);
  input["material"][0].erase("plastic");
  input["material"][0]["law"] = parsed(R"({"type": "table", "points": [[0, 0], [1, 800], [10, 900]]})");
  place.put_json("case.json", input);
  CHECK(asks("check case.json").find("material[0].law.points: " + words) != std::string::npos);
  std::string deck = cube;
  deck.insert(deck.find("*SOLID"), "*PLASTIC\n250,0\n400,10\n");
  place.put("cube.inp", deck);
  CHECK(asks("convert cube.inp --force").find("cube.inp: line 20: material[0].plastic: " + words) !=
        std::string::npos);
  deck.replace(deck.find("400,10"), 6, "200,10");
  place.put("cube.inp", deck);
  CHECK(place.run("convert cube.inp --force")
            .error.find("cube.inp: line 21: material[0].plastic[1]: expected a stress not below") !=
        std::string::npos);
}
