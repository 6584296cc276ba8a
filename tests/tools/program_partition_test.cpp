// SPDX-License-Identifier: BSD-3-Clause
// Cases partitioned once into files by the real program: bitwise the same results as without, on 1 to 8
// ranks; all ranks reject bad files.
#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// A 3D beam with friction, whose mesh nodes, facets and groups are renumbered for the boundary.
nlohmann::json solid_beam() {
  return parsed(R"({
    "mesh": {"box": {"size": [4, 1, 1], "cells": [8, 3, 3], "element": "tet4"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3,
                  "law": {"type": "table", "points": [[0, 0], [0.002, 0.00154], [1, 0.08]]}}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "traction": [0, 0, -0.005]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
                 "friction": {"tresca": 0.002}}],
    "probe": [[4, 1, 1], [4, 0, 0], [2, 0.5, 0.9]]
  })");
}

/// A square of 4 × 4 cells of two triangles each, in Gmsh's format; node numbers are multiples of ten.
std::string square_mesh() {
  std::string nodes, elements;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x)
      nodes +=
          std::to_string(10 * (5 * y + x + 1)) + " " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  int element = 0;
  const auto add = [&](int a, int b, int c) {
    elements += std::to_string(++element) + " 2 2 1 1 " + std::to_string(10 * a) + " " +
                std::to_string(10 * b) + " " + std::to_string(10 * c) + "\n";
  };
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const int corner = 5 * y + x + 1;
      add(corner, corner + 1, corner + 6);
      add(corner, corner + 6, corner + 5);
    }
  }
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n25\n" + nodes + "$EndNodes\n$Elements\n32\n" +
         elements + "$EndElements\n";
}

/// Checks that two vectors, or lists of vectors, agree to the tolerance relative to the largest entry.
void check_close(const nlohmann::json& one, const nlohmann::json& other, double tolerance) {
  const nlohmann::json a = one.flatten(), b = other.flatten();
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (const auto& value : a) largest = std::max(largest, std::abs(value.get<double>()));
  for (const auto& item : a.items()) {
    INFO(item.key());
    CHECK(std::abs(item.value().get<double>() - b[item.key()].get<double>()) <= tolerance * largest);
  }
}

/// Checks for exit code 2 and one line that contains this text.
void check_refused(const Outcome& outcome, const std::string& text) {
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 2);
  CHECK(count_lines(outcome.error) == 1);
  CHECK(outcome.error.find("kacanov: error: --parts: " + text) == 0);
}

}  // namespace

TEST_CASE(
    "a run from parts gives the bits of a run that splits the case itself, and takes its ranks from them") {
  const Workplace place;
  place.put_json("plane.json", small_beam());
  place.put_json("solid.json", solid_beam());
  struct Row {
    std::string name, ranks;
  };
  for (const Row& row : {Row{"plane", "1"}, Row{"plane", "2"}, Row{"solid", "3"}}) {
    const std::string &name = row.name, &ranks = row.ranks;
    INFO(name, " ", ranks);
    const Outcome split = place.run("partition " + name + ".json --output parts --ranks " + ranks);
    INFO("error: ", split.error);
    REQUIRE(split.exit_code == 0);
    CHECK(place.has("parts/part_2.kacanov") == (ranks == "3"));
    const Outcome outcome = place.run("run " + name + ".json --parts parts --output read");
    INFO("error: ", outcome.error);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.error.empty());
    REQUIRE(place.run("run " + name + ".json --output whole --ranks " + ranks).exit_code == 0);
    nlohmann::json read = place.json("read/result.json"), whole = place.json("whole/result.json");
    CHECK(read["ranks"] == std::stoi(ranks));
    for (const char* measured : {"seconds", "peak_memory_bytes"}) {
      read.erase(measured);
      whole.erase(measured);
    }
    CHECK(read == whole);
    for (const auto& entry : std::filesystem::directory_iterator(place.path("whole"))) {
      const std::string file = entry.path().filename().string();
      const bool tells_times =
          std::set<std::string>{"result.json", "summary.txt", "history.csv", "report.html"}.contains(file);
      if (tells_times) continue;
      INFO(file);
      const bool same = contents(place.path("read/" + file)) == contents(place.path("whole/" + file));
      CHECK(same);
    }
  }
}

TEST_CASE("parts are the same bytes every time") {
  const Workplace place;
  place.put_json("solid.json", solid_beam());
  // Memory filled with different bytes: uninitialised values would differ.
  REQUIRE(place.run("partition solid.json --ranks 2 --output once", "MALLOC_PERTURB_=17").exit_code == 0);
  REQUIRE(place.run("partition solid.json --ranks 2 --output again", "MALLOC_PERTURB_=85").exit_code == 0);
  for (const std::string file : {"part_0.kacanov", "part_1.kacanov", "boundary.kacanov"}) {
    INFO(file);
    CHECK(contents(place.path("once/" + file)) == contents(place.path("again/" + file)));
  }
}

TEST_CASE("1, 2, 4 and 8 ranks agree, more of them than cores") {
  const Workplace place;
  place.put_json("solid.json", solid_beam());
  const std::string run = "run solid.json --set solver.tolerance=1e-8 --output ";
  REQUIRE(place.run(run + "one --ranks 1").exit_code == 0);
  const nlohmann::json one = place.json("one/result.json");
  CHECK(one["active_nodes"].get<int>() > 0);
  CHECK(one["plastic_elements"].get<int>() > 0);
  REQUIRE(place.run("partition solid.json --ranks 8 --output parts").exit_code == 0);
  for (const std::string ranks : {"2", "4", "8"}) {
    INFO(ranks);
    const Outcome outcome = place.run(run + "other " + (ranks == "8" ? "--parts parts" : "--ranks " + ranks));
    INFO("error: ", outcome.error);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json other = place.json("other/result.json");
    CHECK(other["ranks"] == std::stoi(ranks));
    for (const char* key : {"status", "active_nodes", "slip_nodes", "plastic_elements"})
      CHECK(other[key] == one[key]);
    for (const char* key : {"probe", "contact_force", "friction_force"})
      check_close(one[key], other[key], 1e-6);
  }
}

TEST_CASE("a run from parts goes on from the checkpoint of one without") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("partition beam.json --ranks 2 --output parts").exit_code == 0);
  REQUIRE(place.run("run beam.json --output out --ranks 1 --set solver.max_outer=3").exit_code == 1);
  const Outcome outcome = place.run("run beam.json --output out --parts parts --restart");
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 0);
  CHECK(place.json("out/result.json")["restarted_after"] == 3);
}

TEST_CASE("a mesh file is read once: a run from parts does without it, but notices another one") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  beam["mesh"] = {{"file", "square.msh"}};
  beam["boundary"] = {{{"on", {{"box", {{0, 0}, {0, 4}}}}}, {"displacement", {0, 0}}}};
  beam["contact"][0]["on"] = {{"box", {{0, 0}, {4, 0}}}};
  beam["contact"][0]["obstacle"] = {{"gap", -0.001}};
  beam["probe"] = {{4, 4}};
  const std::string mesh = square_mesh();
  place.put("square.msh", mesh);
  place.put_json("beam.json", beam);
  const Outcome split = place.run("partition beam.json --ranks 2 --output parts");
  INFO("error: ", split.error);
  REQUIRE(split.exit_code == 0);
  std::filesystem::remove(place.path("square.msh"));
  const Outcome outcome = place.run("run beam.json --parts parts --output out");
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 0);
  place.put("square.msh", mesh + "\n");
  // A different length; or one different digit, as from another version of Gmsh.
  std::string same_length = mesh;
  same_length[mesh.find("\n250 4 4 0") + 5] = '5';
  for (const std::string& other : {mesh + "\n", same_length}) {
    place.put("square.msh", other);
    const Outcome refused = place.run("run beam.json --parts parts --output out");
    check_refused(refused, "parts/boundary.kacanov was made of another mesh: square.msh had " +
                               std::to_string(mesh.size()) + " bytes with hash ");
    CHECK(refused.error.find(", and now has " + std::to_string(other.size()) + " bytes with hash ") !=
          std::string::npos);
  }
  place.put("square.msh", mesh);
  CHECK(place.run("run beam.json --parts parts --output out").exit_code == 0);
}

TEST_CASE("parts of another case or number are refused with what differs, also under one's own mpiexec") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("partition beam.json --ranks 2 --output parts").exit_code == 0);
  const std::string run = "run beam.json --parts parts",
                    mpiexec = KACANOV_MPIEXEC " --quiet --oversubscribe -n ";
  const std::string other = "parts/boundary.kacanov belongs to another case: ";
  for (const std::string& before : {std::string(), mpiexec + "2"}) {
    check_refused(place.run(run + " --set material[0].young=2.0", before),
                  other + "material differs (material[0].young: 1.0 there, 2.0 here)\n");
    check_refused(place.run(run + " --set probe[0][1]=0.5", before),
                  other + "probe differs (probe[0][1]: 1 there, 0.5 here)\n");
    check_refused(place.run("run beam.json --parts none", before), "there is no file none/boundary.kacanov");
  }
  CHECK(place.run(run + " --ranks 3").error ==
        "kacanov: error: --ranks: expected 2, as many as there are parts in parts, got 3\n");
  for (const std::string ranks : {"1", "3"})
    check_refused(place.run(run, mpiexec + ranks),
                  "parts/part_0.kacanov is one of 2 parts, expected as many ranks, but " + ranks);
  CHECK_FALSE(place.has("results"));
  CHECK(place.run(run + " --set solver.tolerance=1e-7").exit_code == 0);
}

TEST_CASE("files that are missing, cut short or damaged are refused by name") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("partition beam.json --ranks 1 --output parts").exit_code == 0);
  const std::string run = "run beam.json --parts parts";
  for (const std::string kind : {"boundary", "part_0"}) {
    const std::string file = "parts/" + kind + ".kacanov", whole = contents(place.path(file));
    INFO(file);
    const auto refusal = [&](const std::string& bytes) {
      place.put(file, bytes);
      const Outcome outcome = place.run(run);
      CHECK(outcome.exit_code == 2);
      CHECK(count_lines(outcome.error) == 1);
      CHECK(outcome.error.rfind("kacanov: error: " + file + ": this ", 0) == 0);
      return outcome.error;
    };
    for (const char* rubbish : {"", "{}"})
      CHECK(refusal(rubbish).find("that this version of kacanov can read") != std::string::npos);
    for (const std::size_t size : {std::size_t{22}, whole.size() / 2, whole.size() - 1})
      CHECK(refusal(whole.substr(0, size)).find("is cut short: " + std::to_string(size) + " bytes") !=
            std::string::npos);
    CHECK(refusal(whole + "x").find("is damaged") != std::string::npos);
    for (std::size_t at = 30; at < whole.size(); at += whole.size() / 30) {
      INFO(at);
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 64);
      refusal(damaged);
    }
    std::filesystem::remove(place.path(file));
    check_refused(place.run(run), "there is no file " + file);
    place.put(file, whole);
  }
  CHECK(place.run(run).exit_code == 0);
}

TEST_CASE("what is wrong with the file of one rank ends all of them, with one message") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const std::string run = "run beam.json --parts parts", file = "parts/part_1.kacanov";
  REQUIRE(place.run("partition beam.json --ranks 2 --output parts").exit_code == 0);
  const std::string whole = contents(place.path(file));
  std::string damaged = whole;
  damaged[whole.size() - 100] ^= 1;
  place.put(file, damaged);
  const Outcome outcome = place.run(run);
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error ==
        "kacanov: error: " + file + ": this part is damaged: its content does not match its hash\n");
  std::filesystem::remove(place.path(file));
  check_refused(place.run(run), "there is no file " + file);
  place.put(file, contents(place.path("parts/part_0.kacanov")));
  check_refused(place.run(run), file + ": expected part 1, got part 0");
}

TEST_CASE("parts of two splits of a mesh file that has changed do not mix") {
  const Workplace place;
  nlohmann::json square = small_beam();
  square["mesh"] = {{"file", "square.msh"}};
  square["boundary"] = {{{"on", {{"box", {{0, 0}, {0, 4}}}}}, {"displacement", {0.1, 0}}}};
  square.erase("contact");
  square.erase("probe");
  place.put_json("square.json", square);
  std::string mesh = square_mesh();
  place.put("square.msh", mesh);
  REQUIRE(place.run("partition square.json --ranks 2 --output before").exit_code == 0);
  const std::string corner = "\n250 4 4 0";
  mesh.replace(mesh.find(corner), corner.size(), "\n250 5 4 0");
  place.put("square.msh", mesh);
  REQUIRE(place.run("partition square.json --ranks 2 --output after").exit_code == 0);
  std::filesystem::rename(place.path("before/part_1.kacanov"), place.path("after/part_1.kacanov"));
  check_refused(place.run("run square.json --parts after"),
                "after/part_1.kacanov belongs to another split than after/boundary.kacanov");
}

TEST_CASE("what partition needs") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  place.put("file", "a file");
  CHECK(place.run("partition beam.json --ranks 2").exit_code == 2);
  CHECK(place.run("partition beam.json --output parts").exit_code == 2);
  const Outcome many = place.run("partition beam.json --ranks 300 --output many");
  CHECK(many.exit_code == 2);
  CHECK(many.error ==
        "kacanov: error: a mesh of 128 elements cannot be split into 300 parts: some would be empty\n");
  const Outcome outcome = place.run("partition beam.json --ranks 2 --output file");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.error.find("--output: the folder file cannot be made") != std::string::npos);
  CHECK(place
            .run("partition beam.json --ranks 2 --output parts",
                 KACANOV_MPIEXEC " --quiet --oversubscribe -n 2")
            .exit_code == 0);
  CHECK(place.run("run beam.json --parts parts").exit_code == 0);
}
