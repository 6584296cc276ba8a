// SPDX-License-Identifier: BSD-3-Clause
// Whole runs of the real program: exit codes, files, keys, the same answer on one rank and two.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "program_runner.hpp"

using namespace kacanov::testing;

TEST_CASE("a run converges, says so, and writes every file and key") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const Outcome outcome = place.run("run beam.json");
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.error.empty());
  CHECK(outcome.output.find("\nconverged: ") != std::string::npos);
  for (const char* file : {"result.json", "summary.txt", "history.csv", "result.pvd", "body.vtu",
                           "contact.vtu", "deformed.svg", "report.html"}) {
    CHECK(place.has(std::string("results/beam/") + file));
  }
  const nlohmann::json result = place.json("results/beam/result.json");
  for (const char* key : {"status",
                          "message",
                          "unknowns",
                          "elements",
                          "contact_nodes",
                          "active_nodes",
                          "slip_nodes",
                          "outer_iterations",
                          "contact_iterations",
                          "cg_iterations",
                          "operator_applications",
                          "applications",
                          "r",
                          "lambda_min",
                          "lambda_max",
                          "r_star",
                          "r_star_estimated",
                          "contact_force",
                          "friction_force",
                          "max_contact_pressure",
                          "max_von_mises",
                          "plastic_elements",
                          "probe",
                          "certificate",
                          "seconds",
                          "peak_memory_bytes",
                          "ranks",
                          "threads",
                          "instruction_set",
                          "warnings",
                          "contact",
                          "reaction",
                          "load",
                          "max_displacement",
                          "max_strain",
                          "max_rotation",
                          "max_von_mises_nodal",
                          "plastic_share",
                          "mesh",
                          "case",
                          "version"}) {
    INFO(key);
    CHECK(result.contains(key));
  }
  for (const char* key : {"equilibrium", "penetration", "tension", "complementarity", "friction_cone",
                          "force_balance", "duality_gap"}) {
    CHECK(result["certificate"][key].get<double>() <= 1e-6);
  }
  const nlohmann::json& applications = result["applications"];
  CHECK(applications["spectrum"].get<int>() + applications["contact"].get<int>() +
            applications["outer"].get<int>() ==
        result["operator_applications"].get<int>());
  CHECK(result["status"] == "converged");
  // The paper's load exceeds small strains by far, and its friction acts on open nodes too.
  REQUIRE(result["warnings"].size() == 3);
  CHECK(result["warnings"][0].get<std::string>().rfind("strains reach ", 0) == 0);
  CHECK(result["warnings"][2].get<std::string>().find("open") != std::string::npos);
  CHECK(result["unknowns"] == 170);
  CHECK(result["elements"] == 128);
  CHECK(result["contact_nodes"] == 16);
  CHECK(result["probe"].size() == 2);
  CHECK(result["probe"][0].size() == 2);
  CHECK(result["contact_force"][1].get<double>() > 0.0);
  CHECK(result["seconds"].contains("total"));
  CHECK(result["r"].size() == result["outer_iterations"]);
}

TEST_CASE("every entry has its forces under its name, and they balance") {
  const Workplace place;
  nlohmann::json document = small_beam();
  document["contact"][0]["name"] = "floor";
  document["boundary"][0]["name"] = "clamp";
  document["boundary"][1]["traction"] = {0.0, -0.003};
  place.put_json("beam.json", document);
  for (const char* ranks : {"--ranks 1", "--ranks 2"}) {
    const Outcome outcome = place.run(std::string("run beam.json --output out ") + ranks);
    INFO("error: ", outcome.error);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json result = place.json("out/result.json");
    CHECK(result["warnings"].empty());
    CHECK(outcome.output.find("obstacle      floor: force (") != std::string::npos);
    const nlohmann::json &floor = result["contact"]["floor"], &clamp = result["reaction"]["clamp"],
                         &load = result["load"]["boundary[1]"];
    CHECK(load["force"][1].get<double>() == doctest::Approx(-0.006));
    CHECK(load["moment"][2].get<double>() == doctest::Approx(-0.018));
    for (const std::size_t c : {0, 1})
      CHECK(std::abs(floor["force"][c].get<double>() + clamp["force"][c].get<double>() +
                     load["force"][c].get<double>()) < 1e-7);
    CHECK(std::abs(floor["moment"][2].get<double>() + clamp["moment"][2].get<double>() +
                   load["moment"][2].get<double>()) < 1e-7);
    CHECK(floor["normal_force"] == result["contact_force"]);
    CHECK(floor["friction_force"] == result["friction_force"]);
    CHECK(floor["sticking"].get<int>() + floor["slipping"].get<int>() == result["active_nodes"]);
    CHECK(floor["max_pressure"] == result["max_contact_pressure"]);
    CHECK(result["mesh"]["volume"].get<double>() == doctest::Approx(4.0));
    CHECK(result["mesh"]["nodes"] == 85);
    CHECK(result["mesh"]["upper"] == nlohmann::json({4.0, 1.0}));
    CHECK(result["case"] == document);
    CHECK(result["max_displacement"]["relative"].get<double>() < 0.1);
    CHECK(result["max_strain"]["at"].size() == 2);
  }
}

TEST_CASE("the answer does not depend on ranks and threads") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  std::vector<nlohmann::json> results;
  for (const char* shape : {"--ranks 1", "--ranks 2", "--ranks 1 --threads 2", "--ranks 2 --threads 2"}) {
    const Outcome outcome =
        place.run(std::string("run beam.json --set solver.tolerance=1e-8 --output out ") + shape);
    INFO(shape, "\nerror: ", outcome.error);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.error.empty());
    results.push_back(place.json("out/result.json"));
    const nlohmann::json &one = results.front(), &other = results.back();
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t c = 0; c < 2; ++c) {
        CHECK(other["probe"][i][c].get<double>() ==
              doctest::Approx(one["probe"][i][c].get<double>()).epsilon(1e-6));
      }
    }
    CHECK(other["active_nodes"] == one["active_nodes"]);
  }
  CHECK(results[1]["ranks"] == 2);
  CHECK(results[2]["threads"] == 2);
  CHECK(place.has("out/body.vtu"));
  CHECK_FALSE(place.has("out/body.pvtu"));
}

TEST_CASE("under mpiexec the program takes the ranks it is given, and speaks once") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const std::string mpiexec = KACANOV_MPIEXEC " --quiet --oversubscribe -n 2";
  const Outcome outcome = place.run("run beam.json", mpiexec);
  INFO("error: ", outcome.error);
  CHECK(outcome.exit_code == 0);
  CHECK(place.json("results/beam/result.json")["ranks"] == 2);
  for (const char* arguments :
       {"run none.json", "run beam.json --ranks 3", "check none.json", "fly beam.json"}) {
    const Outcome refused = place.run(arguments, mpiexec);
    INFO(arguments, "\nerror: ", refused.error);
    CHECK(refused.exit_code == 2);
    CHECK(refused.output.empty());
    CHECK_FALSE(refused.error.empty());
    CHECK(refused.error.find("none.json", refused.error.find("none.json") + 1) == std::string::npos);
  }
}

TEST_CASE("not converged is exit code 1, with all output") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  for (const char* ranks : {"", " --ranks 2"}) {
    const Outcome outcome =
        place.run("run beam.json --set solver.max_outer=1 --output out" + std::string(ranks));
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.error.empty());
    CHECK(outcome.output.find("NOT CONVERGED: ") != std::string::npos);
    CHECK(place.json("out/result.json")["status"] == "not_converged");
    CHECK(place.has("out/result.pvd"));
    CHECK(place.has("out/deformed.svg"));
  }
}

TEST_CASE("Coulomb friction: Newton's method and ADMM agree, within the cone") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const std::string arguments =
      "run beam.json --set contact[0].friction='{\"coulomb\":0.2}' --set solver.tolerance=1e-8 --output ";
  REQUIRE(place.run(arguments + "newton").exit_code == 0);
  REQUIRE(place.run(arguments + "admm --set solver.outer=kacanov --set solver.contact=admm").exit_code == 0);
  const nlohmann::json newton = place.json("newton/result.json"), admm = place.json("admm/result.json");
  for (const std::size_t c : {0, 1}) {
    CHECK(newton["probe"][0][c].get<double>() ==
          doctest::Approx(admm["probe"][0][c].get<double>()).epsilon(1e-5));
  }
  const double friction = newton["friction_force"][0], normal = newton["contact_force"][1];
  CHECK(std::abs(friction) > 0.0);
  CHECK(std::abs(friction) <= 0.2 * normal * (1.0 + 1e-6));
}

TEST_CASE("output options leave out fields and report") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --set output.fields=none --set output.report=false").exit_code == 0);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(place.path("results/beam")))
    files += entry.exists() ? 1 : 0;
  CHECK(files == 1);
  CHECK(place.has("results/beam/result.json"));
}

TEST_CASE("a case without contact is solved too") {
  const Workplace place;
  nlohmann::json document = small_beam();
  document.erase("contact");
  document["boundary"][1]["traction"] = {0, -0.0001};
  place.put_json("beam.json", document);
  const Outcome outcome = place.run("run beam.json");
  INFO(outcome.error);
  CHECK(outcome.exit_code == 0);
  const nlohmann::json result = place.json("results/beam/result.json");
  CHECK(result["contact_nodes"] == 0);
  CHECK(result["probe"][0][1].get<double>() < 0.0);
}

TEST_CASE("spectrum prints r* with its bounds, as text and as JSON") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const Outcome text = place.run("spectrum beam.json");
  CHECK(text.exit_code == 0);
  CHECK(text.output.find("[N; T]") != std::string::npos);
  CHECK(text.output.find("lambda_min") != std::string::npos);
  const Outcome outcome = place.run("spectrum beam.json --json --tolerance 1e-8");
  REQUIRE(outcome.exit_code == 0);
  const nlohmann::json printed = parsed(outcome.output);
  REQUIRE(printed["spectrum"].size() == 2);
  for (const nlohmann::json& entry : printed["spectrum"]) {
    const double low = entry["lambda_min"], high = entry["lambda_max"], r = entry["r_star"];
    CHECK(r == doctest::Approx(1.0 / std::sqrt(low * high)));
    CHECK(entry["lambda_min_bound"].get<double>() <= 1e-6 * low);
  }
  CHECK(printed["spectrum"][1]["lambda_max"].get<double>() >=
        printed["spectrum"][0]["lambda_max"].get<double>());
  CHECK(printed["r_star"] == printed["spectrum"][1]["r_star"]);
  CHECK_FALSE(place.has("results"));
}

TEST_CASE("sweep writes one line a penalty and a picture") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const Outcome outcome = place.run(
      "sweep beam.json --r-min 0.1 --r-max 10 --points 3 --output out --set solver.contact=admm --set "
      "solver.max_contact=3000");
  INFO(outcome.error);
  CHECK(outcome.exit_code == 0);
  const std::string csv = contents(place.path("out/sweep.csv"));
  CHECK(csv.rfind("r,iterations,outer,cg,operator_applications,seconds,status\n0.1,", 0) == 0);
  CHECK(count_lines(csv) == 4);
  CHECK(contents(place.path("out/sweep.svg")).find("<svg") != std::string::npos);
}

TEST_CASE("check says what is selected and writes nothing") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const Outcome outcome = place.run("check beam.json");
  CHECK(outcome.exit_code == 0);
  for (const char* part :
       {"the case is valid", "128 tri3 elements, 85 nodes, 170 unknowns", "\"bottom\": 16 boundary facets",
        "8 facets, length 2", "16 contact points", "estimate"}) {
    INFO(part, "\n", outcome.output);
    CHECK(outcome.output.find(part) != std::string::npos);
  }
  CHECK_FALSE(place.has("results"));
}

TEST_CASE("help and version") {
  const Workplace place;
  CHECK(place.run("--help").exit_code == 0);
  CHECK(place.run("--help").output.find("Exit codes: 0 converged; 1 not converged") != std::string::npos);
  CHECK(place.run("run --help").exit_code == 0);
  CHECK(place.run("--version").output.rfind("kacanov ", 0) == 0);
}

TEST_CASE("what is printed fits 80 columns, has no colour, and is nothing if so wished") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const Outcome usual = place.run("run beam.json -o out --ranks 2 -v");
  CHECK(usual.exit_code == 0);
  std::istringstream lines(usual.printed);
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    CHECK((line.size() <= 80 || line.find(place.path("").string()) != std::string::npos));
  }
  CHECK(usual.printed.find('\033') == std::string::npos);
  for (const char* phase : {" s] making the mesh", " s] splitting into 2 parts", " s] setting the solver up",
                            " s] solving", " s] writing to out"})
    CHECK(usual.printed.find(phase) != std::string::npos);
  CHECK(count_lines(contents(place.path("out/history.csv"))) ==
        1 + place.json("out/result.json")["outer_iterations"].get<std::size_t>());

  const Outcome quiet = place.run("run beam.json -o out -q");
  CHECK(quiet.exit_code == 0);
  CHECK(quiet.printed.empty());
  CHECK(place.run("run beam.json -q -v").exit_code == 2);

  const Outcome shown = place.run("run beam.json -o out", "KACANOV_TERMINAL='120 1'");
  CHECK(shown.printed.find("\033[32mconverged: \033[0m") != std::string::npos);
  CHECK(place.run("run beam.json -o out").printed.find(" s] ") == std::string::npos);
}

TEST_CASE("a spectrum whose solves are cut short says so and ends with exit code 1") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  const std::string cut = " --set solver.max_cg=3";
  const Outcome table = place.run("spectrum beam.json" + cut);
  CHECK(table.exit_code == 1);
  CHECK(table.output.find("NOT CONVERGED") != std::string::npos);
  const Outcome as_json = place.run("spectrum beam.json --json" + cut);
  CHECK(as_json.exit_code == 1);
  const nlohmann::json spectrum = parsed(as_json.output)["spectrum"];
  for (const nlohmann::json& entry : spectrum) CHECK(entry["converged"] == false);
  CHECK(place.run("spectrum beam.json").output.find("NOT CONVERGED") == std::string::npos);
}
