// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: decrease of the energy in Kačanov's method, and answers that do not depend on the numbering
// of the mesh.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Returns stored energy minus the work of the loads.
double total_energy(const Run& run) {
  double work = 0.0;
  for (const auto& entry : run.part.load) work += entry.value * run.solution.displacement[entry.component];
  return reference::energy(run.part.body(), run.solution.displacement) - work;
}

std::vector<Law> curved_laws() {
  Law power = elastic_law(1.0, 0.3), saturating = elastic_law(1.0, 0.3);
  power.form = laws::Power{0.01, 0.4};
  saturating.form = laws::Saturating{0.01, 5.0};
  return {logarithmic_law(0.01), hardening_law(0.01, 0.1), power, saturating};
}

/// Returns the mesh with nodes, elements and the corners of each element in another order.
Mesh shuffled(const Mesh& mesh, unsigned seed) {
  std::mt19937 engine(seed);
  const std::size_t dim = mesh.dim();
  const std::size_t npe = nodes_per_element(mesh.type);
  std::vector<std::int32_t> node(mesh.node_count()), element(mesh.element_count());
  std::iota(node.begin(), node.end(), 0);
  std::iota(element.begin(), element.end(), 0);
  std::shuffle(node.begin(), node.end(), engine);
  std::shuffle(element.begin(), element.end(), engine);
  Mesh other;
  other.type = mesh.type;
  other.coordinates.resize(mesh.coordinates.size());
  for (std::size_t i = 0; i < node.size(); ++i)
    for (std::size_t c = 0; c < dim; ++c)
      other.coordinates[static_cast<std::size_t>(node[i]) * dim + c] = mesh.coordinates[i * dim + c];
  for (const auto e : element) {
    std::vector<std::int32_t> corners;
    for (std::size_t a = 0; a < npe; ++a)
      corners.push_back(node[mesh.elements[static_cast<std::size_t>(e) * npe + a]]);
    std::rotate(corners.begin(), corners.begin() + 1, corners.begin() + 3);  // preserves orientation
    other.elements.insert(other.elements.end(), corners.begin(), corners.end());
  }
  find_boundary(other);
  check_mesh(other);
  return other;
}

}  // namespace

TEST_CASE("the energy falls with every step of Kacanov's method") {
  for (const int dim : {2, 3})
    for (const Law& law : curved_laws()) {
      CAPTURE(dim);
      CAPTURE(law.form.index());
      Model model = beam(dim, law, 0.003);
      model.contact.clear();
      model.solver.outer = SolverOptions::Outer::kacanov;
      double before = 0.0;
      for (int steps = 1; steps <= 8; ++steps) {
        model.solver.max_outer = steps;
        const Run run = run_alone(beam_mesh(dim, dim == 2 ? 4 : 2), model);
        if (run.result().outer_iterations < steps) break;
        const double energy = total_energy(run);
        CAPTURE(steps);
        CHECK(energy < before + 1e-14 * std::abs(before));
        before = energy;
      }
      CHECK(before < 0.0);
    }
}

TEST_CASE("Newton and Kacanov end at the same minimum") {
  for (const Law& law : curved_laws()) {
    CAPTURE(law.form.index());
    Model model = beam(3, law, 0.003);
    model.contact.clear();
    model.solver.tolerance = 1e-8;
    model.solver.outer = SolverOptions::Outer::newton;
    const Run newton = run_alone(beam_mesh(3, 2), model);
    model.solver.outer = SolverOptions::Outer::kacanov;
    model.solver.max_outer = 400;
    const Run kacanov = run_alone(beam_mesh(3, 2), model);
    CHECK(newton.result().status == Status::converged);
    CHECK(kacanov.result().status == Status::converged);
    CHECK(newton.result().outer_iterations <= kacanov.result().outer_iterations);
    CHECK(distance(newton.probe(), kacanov.probe()) < 1e-5 * length(newton.probe()));
    CHECK(total_energy(newton) == doctest::Approx(total_energy(kacanov)).epsilon(1e-9));
  }
}

TEST_CASE("numbering changes nothing but rounding") {
  for (const int dim : {2, 3}) {
    CAPTURE(dim);
    Model model = beam(dim, logarithmic_law(0.01), 0.05, 0.01);
    model.solver.tolerance = 1e-8;
    const Mesh mesh = beam_mesh(dim, dim == 2 ? 8 : 3);
    const Run first = run_alone(mesh, model), second = run_alone(shuffled(mesh, 17), model);
    CHECK(first.result().status == Status::converged);
    CHECK(second.result().status == Status::converged);
    CHECK(distance(first.probe(), second.probe()) < 1e-6 * length(first.probe()));
    CHECK(distance(first.result().contact_force, second.result().contact_force) <
          1e-6 * length(first.result().contact_force));
    CHECK(std::abs(first.result().slip_nodes - second.result().slip_nodes) <= 1);
    CHECK(std::abs(first.result().plastic_elements - second.result().plastic_elements) <= 1);
  }
}

TEST_CASE("a run repeats itself bit by bit") {
  Model model = beam(3, logarithmic_law(0.01), 0.05, 0.01);
  for (const int threads : {1, 2}) {
    RunOptions options;
    options.threads = threads;
    const Run first = run_alone(beam_mesh(3, 3), model, options),
              second = run_alone(beam_mesh(3, 3), model, options);
    CHECK(first.solution.displacement == second.solution.displacement);
  }
}

TEST_CASE("units of length and force scale out") {
  const double length_unit = 1e3, stress_unit = 1e-5;
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01), scaled = model;
  scaled.materials[0].law = logarithmic_law(0.01, stress_unit);
  (*scaled.boundary[1].traction)[1] *= stress_unit;
  scaled.contact[0].friction->tresca *= stress_unit;
  const auto grow = [&](Vector3& x) {
    for (double& v : x) v *= length_unit;
  };
  for (Selector* on : {&scaled.boundary[0].on, &scaled.boundary[1].on, &scaled.contact[0].on}) {
    grow(on->lower);
    grow(on->upper);
  }
  grow(scaled.probes[0]);
  Mesh large = beam_mesh(2, 8);
  for (double& x : large.coordinates) x *= length_unit;
  const Run first = run_alone(beam_mesh(2, 8), model), second = run_alone(std::move(large), scaled);
  CHECK(first.result().status == Status::converged);
  CHECK(second.result().status == Status::converged);
  for (std::size_t c = 0; c < 2; ++c)
    CHECK(second.probe()[c] / length_unit == doctest::Approx(first.probe()[c]).epsilon(1e-5));
  CHECK(second.result().r_star ==
        doctest::Approx(first.result().r_star * stress_unit / length_unit).epsilon(1e-2));
}

TEST_CASE("softening of the squared argument is reported") {
  Model model = beam(2, logarithmic_law(1e-4), 0.005);
  model.materials[0].law.argument = Law::Argument::squared;
  model.materials[0].law.form = laws::Logarithmic{1e-6};
  model.contact.clear();
  model.solver.max_outer = 20;
  const Run run = run_alone(beam_mesh(2, 4), model);
  REQUIRE(run.result().softening_elements > 0);
  CHECK(mentions(run.result().message, "softening"));
}

namespace {

/// The problem of deal.II's step-42: a rigid sphere is pressed by 0.01 into the top of a cube, linear
/// hardening with γ = 0.01.
Model indented_cube() {
  const double mu = 2e5 / 2.6;
  Law law = elastic_law(2e5, 0.3);
  law.form = laws::LinearHardening{400.0 / (2 * mu), 0.01};
  Model model;
  model.materials.push_back({everything(), law, false});  // step-42 uses standard displacement elements
  model.boundary.push_back(moved(named("bottom"), 3));
  for (const char* side : {"left", "right", "front", "back"})
    model.boundary.push_back(displacement(named(side), {0.0, 0.0, std::nullopt}));
  ContactEntry contact;
  contact.on = named("top");
  contact.obstacle = Sphere{{0.5, 0.5, 1.59}, 0.6, Vector3{0, 0, 1}};
  model.contact.push_back(contact);
  return model;
}

Mesh cube_mesh(int n) { return make_box({{1, 1, 1}, {n, n, n}, ElementType::hex8}); }

}  // namespace

TEST_CASE("step-42 of deal.II: its force, in at most 12 steps on any mesh") {
  for (const int n : {8, 16}) {
    CAPTURE(n);
    const Run run = run_alone(cube_mesh(n), indented_cube());
    CHECK(run.result().status == Status::converged);
    CHECK(run.result().outer_iterations <= 12);
    if (n == 8) CHECK(std::abs(run.result().contact_force[2]) == doctest::Approx(37.3058).epsilon(1e-5));
  }
}

TEST_CASE("a first step that nothing but a penetration sets the scale of comes to an end") {
  // No load and no prescribed displacement: at u = 0 there is no force to scale residuals with.
  for (const auto contact : {SolverOptions::Contact::admm, SolverOptions::Contact::dual_admm}) {
    Model model = indented_cube();
    model.solver.outer = SolverOptions::Outer::kacanov;
    model.solver.contact = contact;
    model.solver.penalty = SolverOptions::Penalty::paper;
    const Run run = run_alone(cube_mesh(4), model);
    CHECK(run.result().status == Status::converged);
    CHECK(run.result().contact_iterations < 500);
  }
}

TEST_CASE("iterations hardly grow with the mesh, and are few beside ADMM with r*") {
  for (const double tresca : {0.0, 0.01}) {
    CAPTURE(tresca);
    Model model = beam(2, logarithmic_law(0.01), 0.05, tresca);
    const Run coarse = run_alone(beam_mesh(2, 4), model), fine = run_alone(beam_mesh(2, 16), model);
    CHECK(coarse.result().status == Status::converged);
    CHECK(fine.result().status == Status::converged);
    CHECK(static_cast<double>(fine.result().contact_iterations) <=
          1.8 * static_cast<double>(coarse.result().contact_iterations));
    CHECK(static_cast<double>(fine.result().outer_iterations) <=
          1.8 * static_cast<double>(coarse.result().outer_iterations));
    model.solver.outer = SolverOptions::Outer::kacanov;
    model.solver.contact = SolverOptions::Contact::admm;
    model.solver.penalty = SolverOptions::Penalty::paper;
    const Run paper = run_alone(beam_mesh(2, 16), model);
    CHECK(paper.result().status == Status::converged);
    CHECK(3 * fine.result().operator_applications < paper.result().operator_applications);
    model.solver.penalty = SolverOptions::Penalty::automatic;
    const Run balanced = run_alone(beam_mesh(2, 16), model);
    CHECK(balanced.result().status == Status::converged);
    CHECK(2 * balanced.result().contact_iterations < paper.result().contact_iterations);
  }
}

TEST_CASE("published rules for the penalty lead to the same answer, also from a first one that is far off") {
  using Penalty = SolverOptions::Penalty;
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  model.solver.outer = SolverOptions::Outer::kacanov;
  model.solver.contact = SolverOptions::Contact::admm;
  model.solver.max_outer = 2000;
  const Run balanced = run_alone(beam_mesh(2, 4), model);
  for (const auto penalty : {Penalty::automatic, Penalty::residuals, Penalty::relative_residuals,
                             Penalty::osqp, Penalty::spectral})
    for (const double first : {0.0, 0.03, 30.0}) {
      CAPTURE(static_cast<int>(penalty));
      CAPTURE(first);
      model.solver.penalty = penalty;
      model.solver.r = first;
      const Run run = run_alone(beam_mesh(2, 4), model);
      CHECK(run.result().status == Status::converged);
      if (first > 0.0) CHECK(run.result().r[0] == doctest::Approx(first));
      CHECK(run.result().contact_force[1] ==
            doctest::Approx(balanced.result().contact_force[1]).epsilon(1e-4));
    }
  model.solver.contact = SolverOptions::Contact::dual_admm;
  CHECK_THROWS_AS(run_alone(beam_mesh(2, 4), model), InputError);
}

TEST_CASE("with a Cholesky factor a solve of ADMM takes one or two iterations") {
  Model model = beam(2, elastic_law(1.0, 0.3), 0.05, 0.0);
  model.solver.outer = SolverOptions::Outer::kacanov;
  model.solver.contact = SolverOptions::Contact::admm;
  model.solver.stop = SolverOptions::Stop::paper;
  model.solver.penalty = SolverOptions::Penalty::fixed;
  model.solver.r = 3.0;
  model.solver.preconditioner = SolverOptions::Preconditioner::cholesky;
  const Run run = run_alone(beam_mesh(2, 4), model);
  CHECK(run.result().contact_iterations > 5);
  CHECK(run.result().cg_iterations <= 2 * run.result().contact_iterations);
}

TEST_CASE("solves that are cut short are counted and said, whatever the loop makes of them") {
  using Options = SolverOptions;
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  const Run whole = run_alone(beam_mesh(2, 4), model);
  CHECK(whole.result().unsolved_steps == 0);
  CHECK(whole.result().warnings.empty());
  model.solver.max_cg = 1;
  model.solver.max_outer = 10;
  for (const auto contact :
       {Options::Contact::automatic, Options::Contact::admm, Options::Contact::dual_admm}) {
    model.solver.contact = contact;
    const Run cut = run_alone(beam_mesh(2, 4), model);
    CHECK(cut.result().unsolved_steps > 0);
    REQUIRE(cut.result().warnings.size() == 1);
    CHECK(mentions(cut.result().warnings[0], "solver.max_cg = 1"));
  }
}

TEST_CASE("r* of an estimate that has not converged is said to be a rough one") {
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  model.solver.penalty = SolverOptions::Penalty::paper;
  model.solver.max_outer = 2;
  CHECK(run_alone(beam_mesh(2, 4), model).result().warnings.empty());
  model.solver.max_cg = 2;
  const Run cut = run_alone(beam_mesh(2, 4), model);
  REQUIRE(!cut.result().warnings.empty());
  CHECK(mentions(cut.result().warnings[0], "r*"));
}

TEST_CASE("solve() refuses options that make no sense, in the words of the case file") {
  Model model = beam(2, elastic_law(1.0, 0.3), 0.05);
  const Problem problem = build_problem(beam_mesh(2, 2), model);
  const Part part = distribute(&problem, MPI_COMM_SELF);
  model.solver.max_cg = 0;
  CHECK_THROWS_WITH_AS(solve(part, model.solver, {}), "solver.max_cg: expected a whole number ≥ 1, got 0",
                       InputError);
  CHECK_THROWS_AS(analyse_spectrum(part, model.solver, {}), InputError);
}
