// SPDX-License-Identifier: BSD-3-Clause
// Signorini and friction conditions of solved problems, which must hold at every contact point.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../sanitized.hpp"
#include "contact/traces.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Returns the displacement of a contact point's node.
Vector3 displacement_at(const Run& run, const ContactPoint& point) {
  const std::size_t dim = run.part.dim();
  const double* u = &run.solution.displacement[static_cast<std::size_t>(point.node) * dim];
  return {u[0], u[1], dim == 3 ? u[2] : 0.0};
}

double inner(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Checks gap, pressure and their product; the friction bound; and slip against the friction force.
void check_contact_laws(const Run& run, double tolerance) {
  const Solution& solution = run.solution;
  const double pressure = std::max(run.result().max_contact_pressure, 1e-300);
  double moved_most = 0.0;
  for (const double u : solution.displacement) moved_most = std::max(moved_most, std::abs(u));
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    const ContactPoint& point = run.part.contact[i];
    CAPTURE(i);
    CHECK(solution.gap[i] > -tolerance * moved_most);
    CHECK(solution.pressure[i] > -tolerance * pressure);
    CHECK(std::min(solution.gap[i] / moved_most, solution.pressure[i] / pressure) < tolerance);
    if (point.tangents == 0) {
      CHECK(length(solution.traction[i]) == 0.0);
      continue;
    }
    const double bound = point.tresca + point.coulomb * std::max(0.0, solution.pressure[i]);
    const Vector3 u = displacement_at(run, point);
    Vector3 slip{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      for (std::size_t c = 0; c < 3; ++c) slip[c] += inner(u, point.tangent[k]) * point.tangent[k][c];
    const double force = length(solution.traction[i]);
    CHECK(force <= bound + tolerance * pressure);
    CHECK(std::abs(inner(solution.traction[i], point.normal)) < 1e-12);
    // The friction force opposes the slip at its bound: ψ|u_t| = −force·u_t.
    CHECK(std::abs(bound * length(slip) + inner(solution.traction[i], slip)) <
          3 * tolerance * pressure * moved_most);
    if (solution.contact_status[i] == ContactStatus::stick) CHECK(length(slip) < tolerance * moved_most);
    if (force < 0.99 * bound) CHECK(length(slip) < 3 * tolerance * moved_most / (1 - 0.99));
  }
}

/// Model of a block on the plane z = 0 whose top is displaced.
Model dragged_block(const Vector3& top, double tresca, double coulomb) {
  Model model = elastic_model();
  model.boundary.push_back(moved(named("top"), 3, top));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, tresca, coulomb));
  model.solver.tolerance = 1e-8;
  return model;
}

}  // namespace

TEST_CASE("a sphere pressed into a block") {
  for (const ElementType type : {ElementType::tet4, ElementType::hex8, ElementType::tet10})
    for (const bool given_direction : {false, true}) {
      CAPTURE(static_cast<int>(type));
      CAPTURE(given_direction);
      Model model;
      model.materials.push_back({everything(), logarithmic_law(0.01)});
      model.boundary.push_back(moved(named("bottom"), 3));
      ContactEntry contact;
      contact.on = named("top");
      Sphere sphere{{0.5, 0.5, 1.48}, 0.5, std::nullopt};
      if (given_direction) sphere.direction = Vector3{0, 0, 1};
      contact.obstacle = sphere;
      model.contact.push_back(contact);
      model.solver.tolerance = 1e-7;
      const Run run = run_alone(make_box({{1, 1, 1}, {4, 4, 4}, type}), model);
      CHECK(run.result().status == Status::converged);
      check_contact_laws(run, 1e-6);
      // The obstacle presses the middle node inwards; the rim is free.
      CHECK(run.result().active_nodes > 0);
      CHECK(run.result().active_nodes < run.result().contact_nodes);
      CHECK(run.result().contact_force[2] < 0.0);
      if (given_direction) CHECK(std::abs(run.result().contact_force[0]) < 1e-12);
      // The reaction at the fixed bottom, F − R, balances the obstacle's force.
      CHECK(run.result().certificate.force_balance < 1e-6);
    }
}

TEST_CASE("the beam, with and without friction") {
  for (const int dim : {2, 3})
    for (const double tresca : {0.0, 0.005, 10.0}) {
      CAPTURE(dim);
      CAPTURE(tresca);
      Model model = beam(dim, logarithmic_law(0.01), 0.05, tresca);
      model.solver.tolerance = 1e-8;
      const Run run = run_alone(beam_mesh(dim, dim == 2 ? 8 : 3), model);
      CHECK(run.result().status == Status::converged);
      check_contact_laws(run, 1e-6);
      // A bound of 10 is never reached: all closed points stick.
      if (tresca > 1.0) CHECK(run.result().slip_nodes == 0);
    }
}

TEST_CASE("Tresca: a dragged block slides with all the force there is, straight against its way") {
  const double tresca = 0.01;
  const Run run = run_alone(box_mesh(ElementType::tet4), dragged_block({0.3, 0.4, -0.01}, tresca, 0.0));
  CHECK(run.result().status == Status::converged);
  check_contact_laws(run, 1e-6);
  CHECK(run.result().slip_nodes == run.result().contact_nodes);
  // Area 2; the bottom does not move uniformly, so directions differ slightly between nodes.
  CHECK(length(run.result().friction_force) == doctest::Approx(2 * tresca).epsilon(0.01));
  CHECK(run.result().friction_force[0] == doctest::Approx(-2 * tresca * 0.6).epsilon(0.02));
  CHECK(run.result().friction_force[1] == doctest::Approx(-2 * tresca * 0.8).epsilon(0.02));
  CHECK(run.result().friction_force[2] == 0.0);
}

TEST_CASE("a bound that is never reached holds like glue") {
  // The same block with its bottom clamped has the same displacements.
  Model glued = elastic_model();
  const Vector3 top{0.003, 0.004, -0.02};
  glued.boundary.push_back(moved(named("top"), 3, top));
  glued.boundary.push_back(moved(named("bottom"), 3));
  glued.solver.tolerance = 1e-9;
  const Run clamped = run_alone(box_mesh(ElementType::tet4), glued);
  const Run stuck = run_alone(box_mesh(ElementType::tet4), dragged_block(top, 10.0, 0.0));
  CHECK(stuck.result().status == Status::converged);
  CHECK(stuck.result().slip_nodes == 0);
  for (std::size_t i = 0; i < clamped.solution.displacement.size(); ++i)
    CHECK(std::abs(clamped.solution.displacement[i] - stuck.solution.displacement[i]) < 1e-7 * length(top));
}

TEST_CASE("Coulomb: a sliding block feels the coefficient times the normal force") {
  const double coefficient = 0.2;
  const Run run = run_alone(box_mesh(ElementType::tet4), dragged_block({0.3, 0.0, -0.02}, 0.0, coefficient));
  CHECK(run.result().status == Status::converged);
  check_contact_laws(run, 1e-6);
  const double normal = run.result().contact_force[2];
  CHECK(normal > 0.0);
  CHECK(run.result().friction_force[0] == doctest::Approx(-coefficient * normal).epsilon(0.02));
}

TEST_CASE("Coulomb: the laws hold, and the solution is Tresca's with the bound it found") {
  for (const int dim : {2, 3})
    for (const double coefficient : {0.1, 0.3, 1.0}) {
      CAPTURE(dim);
      CAPTURE(coefficient);
      Model model = beam(dim, logarithmic_law(0.01), 0.05);
      if (dim == 3) (*model.boundary[1].traction)[1] = 0.004;  // oblique, so that the slip direction rotates
      model.contact[0].friction = Friction{0.0, coefficient};
      model.solver.tolerance = 1e-10;  // so tight that even the last step hardly changes the bound
      const Run run = run_alone(beam_mesh(dim, dim == 2 ? 8 : 3), model);
      model.solver.tolerance = 1e-8;
      CHECK(run.result().status == Status::converged);
      CHECK(run.result().slip_nodes > 0);
      CHECK(run.result().bound_change < 1e-6);
      check_contact_laws(run, 1e-6);

      Part frozen = distribute(&run.problem, MPI_COMM_SELF);
      for (std::size_t i = 0; i < frozen.contact.size(); ++i) {
        frozen.contact[i].coulomb = 0.0;
        frozen.contact[i].tresca = coefficient * std::max(0.0, run.solution.pressure[i]);
      }
      const Solution tresca = solve(frozen, model.solver, {});
      CHECK(tresca.result.status == Status::converged);
      CHECK(distance(tresca.result.probe[0], run.probe()) < 1e-5 * length(run.probe()));
      CHECK(distance(tresca.result.friction_force, run.result().friction_force) <
            1e-5 * length(run.result().contact_force));

      model.solver.outer = SolverOptions::Outer::kacanov;
      model.solver.contact = SolverOptions::Contact::admm;
      model.solver.max_outer = 400;
      const Run admm = run_alone(beam_mesh(dim, dim == 2 ? 8 : 3), model);
      CHECK(admm.result().status == Status::converged);
      CHECK(distance(admm.probe(), run.probe()) < 1e-5 * length(run.probe()));
    }
}

TEST_CASE("Coulomb: a run cut short says that its bound still moves") {
  Model model = beam(2, elastic_law(1.0, 0.3), 0.05);
  model.contact[0].friction = Friction{0.0, 0.3};
  model.solver.max_outer = 4;
  const Run run = run_alone(beam_mesh(2, 8), model);
  CHECK(run.result().status == Status::not_converged);
  CHECK(run.result().bound_change > 1e-6);
  CHECK(mentions(run.result().message, "Coulomb's bound still moves"));
}

TEST_CASE("Coulomb friction by Newton steps alone: no retreat to ADMM, and its answer" *
          doctest::skip(sanitized)) {
  Model model = beam(2, elastic_law(1.0, 0.3), 0.05);
  model.solver.tolerance = 1e-7;
  std::ptrdiff_t retreats = 0;
  for (const double coulomb : {0.5, 0.8, 1.2}) {
    CAPTURE(coulomb);
    model.contact[0].friction = Friction{0.0, coulomb};
    model.solver.contact = SolverOptions::Contact::admm;
    const Run straight = run_alone(beam_mesh(2, 12), model);
    CHECK(straight.result().status == Status::converged);
    model.solver.contact = SolverOptions::Contact::automatic;
    std::vector<std::string> phases;
    RunOptions options;
    options.progress = [&](const ProgressStep& step) { phases.push_back(step.phase); };
    const Run newton = run_alone(beam_mesh(2, 12), model, options);
    REQUIRE(phases.size() > 1);
    retreats += std::count(phases.begin() + 1, phases.end(), "admm");
    CHECK(phases.back() == "active_set");
    CHECK(newton.result().status == Status::converged);
    CHECK(distance(straight.probe(), newton.probe()) < 1e-5 * length(straight.probe()));
    check_contact_laws(newton, 1e-5);
  }
  CHECK(retreats == 0);
}

TEST_CASE("friction far beyond what a yielding body carries does not throw it about" *
          doctest::skip(sanitized)) {
  // The top drags the body along its obstacle; to slip, the bottom would have to strain the body to e⁶⁵ times
  // its yield strain.
  Model model;
  model.materials.push_back({everything(), logarithmic_law(1e-4, 200.0)});
  model.boundary.push_back(moved(named("top"), 3, {0.1, 0.0, -0.02}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0.05, 0, 1}, 1.0));
  const Mesh mesh = make_box({{2, 1, 1}, {10, 5, 5}, ElementType::tet4});
  const Run run = run_alone(mesh, model);
  CHECK(run.result().status == Status::converged);
  CHECK(run.result().slip_nodes == 0);
  CHECK(run.result().outer_iterations < 20);
  model.solver.contact = SolverOptions::Contact::admm;
  model.solver.max_outer = 300;
  const Run other = run_alone(mesh, model);
  CHECK(other.result().status == Status::converged);
  CHECK(distance(run.result().friction_force, other.result().friction_force) <
        1e-4 * length(other.result().friction_force));
}

TEST_CASE("where the tangent has gone too far the secant leads on until half the residual is left") {
  // A block dragged up a slope, to thousands of yield strains.
  Model model;
  model.materials.push_back({everything(), logarithmic_law(1e-4, 200.0)});
  model.boundary.push_back(moved(named("top"), 3, {0.6, 0.2, -0.2}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0.2, 0, 1}, 0.0, 0.7));
  std::vector<ProgressStep> steps;
  RunOptions options;
  options.progress = [&](const ProgressStep& step) { steps.push_back(step); };
  const Run run = run_alone(make_box({{2, 1, 1}, {8, 4, 4}, ElementType::tet4}), model, options);
  CHECK(run.result().status == Status::converged);
  double reach = 0.3;
  int too_far = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (steps[i].phase != std::string("newton")) continue;
    const double before = steps[i - 1].certificate.equilibrium, after = steps[i].certificate.equilibrium;
    CHECK(before <= reach);
    if (after <= before) continue;
    ++too_far;
    reach = std::max(0.003, 0.5 * before);
  }
  CHECK(too_far > 0);
}

TEST_CASE("an obstacle out of reach changes nothing") {
  Model model = beam(2, logarithmic_law(0.01), 0.001);
  model.solver.tolerance = 1e-9;
  Model free = model;
  free.contact.clear();
  // Far below, and with Coulomb friction, whose bound vanishes with the pressure.
  model.contact[0] = on_plane(model.contact[0].on, {0, -5, 0}, {0, 1, 0}, 0.0, 0.3);
  const Run without = run_alone(beam_mesh(2, 4), free), out_of_reach = run_alone(beam_mesh(2, 4), model);
  CHECK(without.result().status == Status::converged);
  CHECK(out_of_reach.result().status == Status::converged);
  CHECK(out_of_reach.result().active_nodes == 0);
  CHECK(distance(without.probe(), out_of_reach.probe()) < 1e-7 * length(without.probe()));
}

TEST_CASE("every choice of the contact method and of r leads to the same answer") {
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  model.solver.tolerance = 1e-7;
  const Run reference = run_alone(beam_mesh(2, 4), model);
  REQUIRE(reference.result().status == Status::converged);
  const auto compare = [&](const SolverOptions& options) {
    Model other = model;
    other.solver = options;
    const Run run = run_alone(beam_mesh(2, 4), other);
    CHECK(run.result().status == Status::converged);
    CHECK(distance(run.probe(), reference.probe()) < 1e-5 * length(reference.probe()));
    CHECK(distance(run.result().contact_force, reference.result().contact_force) <
          1e-5 * length(reference.result().contact_force));
  };
  using Outer = SolverOptions::Outer;
  using Contact = SolverOptions::Contact;
  for (const auto& [outer, contact] : {std::pair{Outer::kacanov, Contact::admm},
                                       {Outer::automatic, Contact::admm},
                                       {Outer::kacanov, Contact::active_set},
                                       {Outer::newton, Contact::active_set}}) {
    SolverOptions options = model.solver;
    options.outer = outer;
    options.contact = contact;
    options.max_outer = 200;
    CAPTURE(static_cast<int>(options.outer));
    CAPTURE(static_cast<int>(options.contact));
    compare(options);
  }
  for (const auto penalty : {SolverOptions::Penalty::paper, SolverOptions::Penalty::fixed}) {
    SolverOptions options = model.solver;
    options.penalty = penalty;
    options.r = 5.0;
    options.contact = SolverOptions::Contact::admm;
    CAPTURE(static_cast<int>(penalty));
    compare(options);
  }
}

TEST_CASE("a penalty that an approach has lowered is the first one again once there is contact") {
  // A column pushed against a wall at a third of its length.
  const Mesh column = make_box({{9, 1, 1}, {18, 2, 1}, ElementType::tri3});
  Model model;
  model.materials.push_back({everything(), logarithmic_law(0.01)});
  model.boundary.push_back(moved(named("right"), 2, {-3.05, 0, 0}));
  model.contact.push_back(on_plane(named("left"), {-3, 0, 0}, {1, 0, 0}));
  model.solver.outer = SolverOptions::Outer::kacanov;
  for (const auto contact : {SolverOptions::Contact::admm, SolverOptions::Contact::dual_admm}) {
    CAPTURE(static_cast<int>(contact));
    model.solver.contact = contact;
    const auto after = [&](int steps) {
      model.solver.max_outer = steps;
      return run_alone(column, model);
    };
    int steps = 1;
    while (steps < 10 && after(steps).result().active_nodes == 0) ++steps;
    const auto r = after(steps + 1).result().r;
    const auto arrival = static_cast<std::size_t>(steps) - 1;
    REQUIRE(arrival > 0);
    CHECK(r.at(arrival) < 0.6 * r[0]);
    CHECK(r.at(arrival + 1) == r[0]);
  }
}

TEST_CASE("the two tangents of a turned plane are as good as any") {
  // A 3D solution, rotated together with all its data.
  const Rotation turn(3, 0.9);
  const auto solve_turned = [](const std::function<Vector3(const Vector3&)>& map) {
    Mesh mesh = box_mesh(ElementType::tet4);
    map_nodes(mesh, map);
    Model model;
    model.materials.push_back({everything(), logarithmic_law(0.005)});
    model.boundary.push_back(moved(named("top"), 3, map({0.01, 0.02, -0.01})));
    model.contact.push_back(on_plane(named("bottom"), {}, map({0, 0, 1}), 0.004));
    model.solver.tolerance = 1e-8;
    return run_alone(std::move(mesh), model);
  };
  const Run straight = solve_turned([](const Vector3&x) { return x; }), turned = solve_turned(turn);
  CHECK(straight.result().status == Status::converged);
  CHECK(turned.result().status == Status::converged);
  CHECK(straight.result().slip_nodes == turned.result().slip_nodes);
  const auto u = gather_nodal(straight.part, straight.solution.displacement, 3);
  const auto v = gather_nodal(turned.part, turned.solution.displacement, 3);
  for (std::size_t i = 0; i < straight.part.nodes(); ++i) {
    const double* a = &u[3 * i];
    const double* b = &v[3 * i];
    CHECK(distance(turn({a[0], a[1], a[2]}), {b[0], b[1], b[2]}) < 1e-7);
  }
  CHECK(distance(turn(straight.result().friction_force), turned.result().friction_force) < 1e-8);
}
