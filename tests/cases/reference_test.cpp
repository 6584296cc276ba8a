// SPDX-License-Identifier: BSD-3-Clause
// Whole runs, compared with the values of an independent implementation (reference/README.md).
#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gmsh_reader.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;
using nlohmann::json;

namespace {

json read(const std::string& name) {
  std::ifstream file(std::string(KACANOV_REFERENCE) + "/" + name);
  REQUIRE(file.good());
  return json::parse(file);
}

bool has(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

Law law_named(const std::string& name, double x0) {
  if (has(name, "log law")) return logarithmic_law(x0);
  if (has(name, "linear hardening")) return hardening_law(x0, 0.1);
  return elastic_law(1.0, 0.3);
}

Mesh rocker_mesh() {
  Mesh mesh = read_gmsh(KACANOV_ROCKER);
  find_boundary(mesh);
  check_mesh(mesh);
  return mesh;
}

Model rocker_model(const std::string& name) {
  const bool tresca = has(name, "Tresca");
  Model model;
  model.materials.push_back({everything(), law_named(name, 0.005)});
  model.boundary.push_back(moved(named("clamp"), 3));
  model.boundary.push_back(
      traction(named("top"), tresca ? Vector3{0.004, 0.003, -0.02} : Vector3{0, 0, -0.02}));
  model.contact.push_back(on_plane(named("base"), {}, {0, 0, 1}, tresca ? 0.003 : 0.0));
  model.probes.push_back({2.0, 0.0, 0.6});
  return model;
}

void check_near(double value, double expected, double tolerance) {
  CHECK(value == doctest::Approx(expected).epsilon(tolerance).scale(0.0));
}

void check_beam(const json& mesh, bool small_loads) {
  const int n = static_cast<int>(std::lround(1.0 / mesh.at("h").get<double>()));
  for (const json& expected : mesh.at("cases")) {
    const auto name = expected.at("case").get<std::string>();
    const double f = has(name, "f=0.005") ? 0.005 : 0.05;
    if (f < 0.01 && !small_loads) continue;
    CAPTURE(n);
    CAPTURE(name);
    Model model = beam(2, law_named(name, 0.01), f, has(name, "Tresca") ? 0.01 : 0.0);
    model.probes.push_back({4, 0, 0});
    model.solver.tolerance = 1e-7;
    const Run run = run_alone(beam_mesh(2, n), model);
    const Result& result = run.result();
    CHECK(result.status == Status::converged);
    check_near(run.probe(0)[1], expected.at("uy_at_4_1"), 1e-4);
    check_near(run.probe(1)[0], expected.at("ux_at_4_0"), 1e-4);
    check_near(result.contact_force[1], expected.at("contact_force"), 1e-4);
    check_near(result.max_contact_pressure, expected.at("max_contact_pressure"), 1e-4);
    check_near(result.max_von_mises, expected.at("max_von_mises"), 1e-4);
    CHECK(result.contact_nodes == expected.at("of_nodes").get<int>());
    CHECK(std::abs(result.active_nodes - expected.at("contact_nodes").get<int>()) <= 1);
    CHECK(std::abs(result.plastic_elements - expected.at("plastic_triangles").get<int>()) <= 1);
    if (!expected.contains("friction_force")) continue;
    check_near(result.friction_force[0], expected.at("friction_force"), 1e-4);
    CHECK(std::abs(result.slip_nodes - expected.at("slip_nodes").get<int>()) <= 1);
  }
}

void check_spectrum(const SpectrumResult& found, double low, double high, double tolerance) {
  check_near(found.lambda_min, low, tolerance);
  check_near(found.lambda_max, high, tolerance);
  check_near(found.r_star, 1.0 / std::sqrt(low * high), tolerance);
}

/// Checks the spectra of N and of [N; T]: to 1 % with the default tolerance, to 6 digits with a tight one.
void check_spectra(const Part& part, bool tight, double low, double high, double low_both, double high_both) {
  SolverOptions options;
  if (tight) options.spectrum_tolerance = 1e-9;
  const auto found = analyse_spectrum(part, options, {});
  REQUIRE(found.size() == 2);
  CHECK_FALSE(found[0].friction);
  CHECK(found[1].friction);
  check_spectrum(found[0], low, high, tight ? 1e-6 : 1e-2);
  check_spectrum(found[1], low_both, high_both, tight ? 1e-6 : 1e-2);
}

}  // namespace

TEST_CASE("beam in 2D, h = 1/8 and 1/16") {
  const json all = read("beam2d.json");
  check_beam(all.at(0), true);
  check_beam(all.at(1), true);
}

TEST_CASE("beam in 2D, h = 1/32") { check_beam(read("beam2d.json").at(2), false); }

TEST_CASE("spectra of the beam in 2D, and the growth of r*") {
  std::vector<double> r_star;
  for (const json& mesh : read("beam2d.json")) {
    const int n = static_cast<int>(std::lround(1.0 / mesh.at("h").get<double>()));
    CAPTURE(n);
    const Problem problem = build_problem(beam_mesh(2, n), beam(2, elastic_law(1.0, 0.3), 0.05, 0.01));
    const json& normal = mesh.at("elastic");
    const json& both = mesh.at("elastic_normal_and_tangential");
    const Part part = distribute(&problem, MPI_COMM_SELF);
    for (const bool tight : {false, true}) {
      if (tight && n > 16) continue;  // the third mesh would add ten seconds and no information
      check_spectra(part, tight, normal.at("lambda_min"), normal.at("lambda_max"), both.at("lambda_min"),
                    both.at("lambda_max"));
    }
    r_star.push_back(analyse_spectrum(part, {}, {}).at(0).r_star);
  }
  // In the limit r* grows as h^-½.
  for (std::size_t i = 1; i < r_star.size(); ++i)
    CHECK(r_star[i] / r_star[i - 1] == doctest::Approx(std::sqrt(2.0)).epsilon(0.03));
}

TEST_CASE("rocker") {
  const json all = read("rocker.json");
  for (const auto& [name, expected] : all.at("cases").items()) {
    CAPTURE(name);
    Model model = rocker_model(name);
    model.solver.tolerance = 1e-7;
    const Run run = run_alone(rocker_mesh(), model);
    const Result& result = run.result();
    CHECK(result.status == Status::converged);
    const Vector3 probe = expected.at("probe").get<Vector3>();
    CHECK(distance(run.probe(), probe) < 1e-4 * length(probe));
    check_near(result.contact_force[2], expected.at("contact_force"), 1e-4);
    check_near(result.max_contact_pressure, expected.at("max_contact_pressure"), 1e-4);
    check_near(result.max_von_mises, expected.at("max_von_mises"), 1e-4);
    CHECK(result.contact_nodes == expected.at("contact_nodes").get<int>());
    CHECK(std::abs(result.active_nodes - expected.at("active_nodes").get<int>()) <= 1);
    CHECK(std::abs(result.plastic_elements - expected.at("plastic_elements").get<int>()) <= 1);
    if (!expected.contains("friction_force")) continue;
    for (std::size_t c = 0; c < 2; ++c)
      check_near(result.friction_force[c], expected.at("friction_force").at(c), 1e-4);
    CHECK(std::abs(result.slip_nodes - expected.at("slip_nodes").get<int>()) <= 1);
  }
}

TEST_CASE("spectra of the rocker") {
  const json all = read("rocker.json");
  for (const auto& [name, expected] : all.at("cases").items()) {
    if (!expected.contains("elastic_both_lambda_min")) continue;
    const Problem problem = build_problem(rocker_mesh(), rocker_model(name));
    for (const bool tight : {false, true})
      check_spectra(distribute(&problem, MPI_COMM_SELF), tight, expected.at("elastic_lambda_min"),
                    expected.at("elastic_lambda_max"), expected.at("elastic_both_lambda_min"),
                    expected.at("elastic_both_lambda_max"));
  }
}
