// SPDX-License-Identifier: BSD-3-Clause
// Load steps: the solution does not depend on the path to the full load, every step solves its own problem;
// diagnosis of runs that do not converge.
#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

#include "../sanitized.hpp"
#include "nonlinear/convergence_diagnosis.hpp"
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

/// A block pressed by a prescribed displacement, a load, and a ball that penetrates it by 0.03 initially.
Model pressed_block(int dim, const Law& law) {
  const std::size_t up = dim - 1;
  Vector3 load{}, under{};
  load[0] = 0.004;
  under[up] = -1.0;
  Model model;
  model.materials.push_back({everything(), law});
  std::array<std::optional<double>, 3> push{};
  push[up] = -0.02;
  model.boundary.push_back(moved(named("left"), dim));
  model.boundary.push_back(displacement(named("top"), push));
  model.boundary.push_back(traction(named("right"), load));
  ContactEntry ball;
  ball.on = named("bottom");
  Sphere sphere;
  sphere.radius = 1.0;
  sphere.centre = {1.0, 0.5, 0.25};
  sphere.centre[up] = -1.0 + 0.03;
  sphere.direction = under;
  ball.obstacle = sphere;
  ball.friction = Friction{0.002, 0.0};
  model.contact.push_back(ball);
  model.probes.push_back({2.0, 0.5, dim == 3 ? 0.25 : 0.0});
  model.solver.tolerance = 1e-9;
  return model;
}

double difference(const Run& a, const Run& b) {
  double most = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.solution.displacement.size(); ++i) {
    most = std::max(most, std::abs(a.solution.displacement[i] - b.solution.displacement[i]));
    size = std::max(size, std::abs(b.solution.displacement[i]));
  }
  return most / size;
}

}  // namespace

TEST_CASE("the answer does not depend on the load steps") {
  for (const ElementType type : {ElementType::tri3, ElementType::hex8})
    for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.005), hardening_law(0.005, 0.05)}) {
      const int dim = dimension(type);
      CAPTURE(dim);
      CAPTURE(law.form.index());
      Model model = pressed_block(dim, law);
      // No prescribed displacement on the left of the top, which is fixed already.
      model.boundary[1].on = box({0.5, 0.0, 0.0}, {2.0, 1.0, 0.5});
      if (dim == 2) std::get<Sphere>(model.contact[0].obstacle).centre[2] = 0.0;
      model.boundary[1].on.lower[dim - 1] = dim == 2 ? 1.0 : 0.5;
      const Run at_once = run_alone(box_mesh(type), model);
      REQUIRE(at_once.result().status == Status::converged);
      CHECK(at_once.result().load_steps.empty());
      for (const std::vector<double>& factors : {std::vector{0.25, 0.5, 0.75, 1.0}, std::vector{0.9, 1.0}}) {
        model.solver.load_steps = factors;
        const Run in_steps = run_alone(box_mesh(type), model);
        CHECK(in_steps.result().status == Status::converged);
        CHECK(difference(in_steps, at_once) < 1e-7);
        const auto& history = in_steps.result().load_steps;
        REQUIRE(history.size() == factors.size());
        int steps = 0;
        for (std::size_t i = 0; i < factors.size(); ++i) {
          CHECK(history[i].factor == factors[i]);
          CHECK(history[i].worst_residual <= model.solver.tolerance);
          steps += history[i].outer_iterations;
        }
        CHECK(steps == in_steps.result().outer_iterations);
        CHECK(history.back().probe.at(0) == in_steps.probe());
        CHECK(history.back().contact_force == in_steps.result().contact_force);
      }
    }
}

TEST_CASE("a load step is the problem with its share of load, displacement and indentation") {
  Model model = pressed_block(2, logarithmic_law(0.005));
  std::get<Sphere>(model.contact[0].obstacle).centre[2] = 0.0;
  model.boundary[1].on = box({0.5, 1.0, 0.0}, {2.0, 1.0, 0.0});
  model.solver.load_steps = {0.4, 1.0};
  const Run run = run_alone(box_mesh(ElementType::tri3), model);
  Model share = model;
  share.solver.load_steps.clear();
  (*share.boundary[1].displacement)[1] = 0.4 * -0.02;
  share.boundary[2].traction = Vector3{0.4 * 0.004, 0.0, 0.0};
  std::get<Sphere>(share.contact[0].obstacle).centre[1] = -1.0 + 0.4 * 0.03;
  const Run alone = run_alone(box_mesh(ElementType::tri3), share);
  const LoadStep& first = run.result().load_steps.at(0);
  CHECK(distance(first.probe.at(0), alone.probe()) < 1e-7 * length(alone.probe()));
  CHECK(distance(first.contact_force, alone.result().contact_force) <
        1e-7 * length(alone.result().contact_force));
  CHECK(first.active_nodes == alone.result().active_nodes);
  CHECK(first.plastic_elements == alone.result().plastic_elements);
}

TEST_CASE("a load step that does not converge is the last one, and named") {
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  model.solver.load_steps = {0.5, 1.0};
  model.solver.max_outer = 2;
  const Run run = run_alone(beam_mesh(2, 2), model);
  CHECK(run.result().status == Status::not_converged);
  CHECK(run.result().message.find("load step 1 of 2 (factor 0.5): ") == 0);
  CHECK(run.result().load_steps.size() == 1);
  CHECK(run.result().load_steps[0].worst_residual > model.solver.tolerance);
}

TEST_CASE("a run goes on in the middle of its load steps") {
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  model.solver.tolerance = 1e-8;
  model.solver.load_steps = {0.3, 0.6, 1.0};
  const Problem problem = build_problem(beam_mesh(2, 4), model);
  Part part = distribute(&problem, MPI_COMM_SELF);
  std::vector<Checkpoint> all;
  RunOptions options;
  options.checkpoint = [&](const Checkpoint& c) { all.push_back(c); };
  const Solution whole = solve(part, model.solver, options);
  REQUIRE(whole.result.status == Status::converged);
  for (const std::size_t at : {all.size() / 3, all.size() / 2, all.size() - 1}) {
    RunOptions rest;
    rest.start = &all[at];
    const Solution solution = solve(part, model.solver, rest);
    CHECK(solution.result.status == Status::converged);
    REQUIRE(solution.result.load_steps.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(distance(solution.result.load_steps[i].probe[0], whole.result.load_steps[i].probe[0]) <
            1e-6 * length(whole.result.load_steps[i].probe[0]));
  }
}

namespace {

/// A cube on the floor pulled along x with uniform stress: `share` times the limit load of the law without
/// hardening.
Model pulled(const Law& law, double share) {
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named("front"), 1));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}));
  // Uniaxial stress has ‖dev τ‖ = √(2/3) σ, which at yield is 2 μ x₀.
  const double yield = std::sqrt(1.5) * 2.0 * law.shear * 0.002;
  const auto* saturating = std::get_if<laws::Saturating>(&law.form);
  const double limit = yield * (saturating ? 1.0 + saturating->q : 1.0);
  model.boundary.push_back(traction(named("right"), {share * limit, 0, 0}));
  model.boundary.push_back(traction(named("top"), {0, 0, -1e-4 * limit}));
  return model;
}

}  // namespace

TEST_CASE("beyond a limit load the run ends with the factor that it has reached, and says so") {
  Law law = elastic_law(1.0, 0.3);
  law.form = laws::Saturating{0.002, 2.0};
  const Mesh cube = make_box({{1, 1, 1}, {2, 2, 2}, ElementType::hex8});
  const Run below = run_alone(cube, pulled(law, 0.99));
  CHECK(below.result().status == Status::converged);
  CHECK(below.result().load_cuts == 0);
  CHECK(below.result().load_reached == 1.0);
  const Run beyond = run_alone(cube, pulled(law, 1.05));
  CHECK(beyond.result().status == Status::not_converged);
  CHECK(beyond.result().load_cuts > 0);
  CHECK(beyond.result().load_cuts <= 7);
  CHECK(beyond.result().outer_iterations <= 150);
  // Within a fraction of a load step of the limit, and with the corresponding state.
  CHECK(beyond.result().load_reached < 1.001 / 1.05);
  CHECK(beyond.result().load_reached > 0.97 / 1.05);
  CHECK(mentions(beyond.result().message, "plastic collapse: the body carries the load factor 0.9"));
  CHECK(beyond.result().certificate.worst() <= 1e-6);
}

TEST_CASE("strains of orders of magnitude beyond the yield strain take few steps") {
  Law flat = elastic_law(1.0, 0.3);
  flat.form = laws::Power{0.002, 0.1};
  // 3¹⁰ times the yield strain; Kačanov steps alone would take hundreds. The contact force is only 3e-5 of
  // the load and is accurate as well.
  const Run run = run_alone(make_box({{1, 1, 1}, {2, 2, 2}, ElementType::hex8}), pulled(flat, 3.0));
  CHECK(run.result().status == Status::converged);
  CHECK(run.result().load_cuts == 0);
  CHECK(run.result().outer_iterations <= 45);
  CHECK(run.result().max_displacement.value > 30.0);
  CHECK(run.result().contact_force[2] ==
        doctest::Approx(run.result().load[1].total.force[2] * -1.0).epsilon(1e-3));
}

TEST_CASE("a body that flows like a fluid under friction converges: its solves end" *
          doctest::skip(sanitized)) {
  Law flat = elastic_law(1.0, 0.3);
  flat.form = laws::Power{0.002, 0.1};
  const double yield = std::sqrt(1.5) * 2.0 * flat.shear * 0.002;
  Model model;
  model.materials.push_back({everything(), flat});
  model.boundary.push_back(traction(named("top"), {0.8 * yield, 0.5 * yield, -4.0 * yield}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.0, 0.6));
  const Run run = run_alone(make_box({{3, 1.4, 1}, {12, 6, 5}, ElementType::hex8}), model);
  CHECK(run.result().status == Status::converged);
  CHECK(run.result().outer_iterations <= 80);
  CHECK(run.result().cg_iterations <= 10'000);
}

TEST_CASE("nearly perfect plasticity a little beyond its yield load converges") {
  const Mesh cube = make_box({{1, 1, 1}, {2, 2, 2}, ElementType::hex8});
  Law flat = elastic_law(1.0, 0.3);
  flat.form = laws::LinearHardening{0.002, 1e-6};
  CHECK(run_alone(cube, pulled(flat, 1.01)).result().status == Status::converged);
  flat.form = laws::Power{0.002, 0.02};
  CHECK(run_alone(cube, pulled(flat, 1.01)).result().status == Status::converged);
}

namespace {

/// A block pressed on the floor with friction.
Model pressed() {
  Model model;
  model.materials.push_back({everything(), elastic_law(210e3, 0.3)});
  model.boundary.push_back(moved(named("left"), 3));
  model.boundary.push_back(traction(named("top"), {0, 0, -20.0}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.0, 0.3));
  return model;
}

}  // namespace

TEST_CASE("the node that changes most is named with its place in the user's units") {
  const Problem problem = build_problem(box_mesh(ElementType::tet4), pressed());
  const Part part = distribute(&problem, MPI_COMM_SELF);
  const std::size_t points = part.contact.size();
  ContactState state;
  state.trace = state.phi = state.lambda = ContactValues(points);
  state.lambda.normal.assign(points, 1.0);
  state.bound.assign(points, 0.3);
  ContactChanges changes;
  const std::size_t first = 3, second = 5;
  for (int step = 0; step < 12; ++step) {
    state.lambda.normal[first] = step % 2;  // with its bound: open, or sticking
    state.bound[first] = 0.3 * (step % 2);
    state.lambda.tangential[2 * second] = step % 4 < 2 ? 0.0 : 0.3;  // sticks, then slips
    changes.note(part.contact.points(), state);
  }
  CHECK(changes.count(first) == 11);
  CHECK(changes.count(second) == 5);
  CHECK(changes.count(0) == 0);
  const std::string said = who_cycles(part, changes, 2.0);
  const std::int32_t node = part.contact[first].node;
  std::ostringstream place;
  place << "node " << part.node_tag(node) << " at (" << 2.0 * part.coordinates[3 * node] << ", "
        << 2.0 * part.coordinates[3 * node + 1] << ", 0)";
  CHECK(mentions(said, place.str()));
  CHECK(mentions(said, "in 11 of the last 16 steps, and 1 contact points more"));
  // Points that stop changing are forgotten.
  for (int step = 0; step < ContactChanges::window; ++step) changes.note(part.contact.points(), state);
  CHECK(who_cycles(part, changes, 1.0).empty());
}

TEST_CASE("a run cut short says which residual is left") {
  Model model = pressed();
  model.materials[0].law.form = laws::Logarithmic{1e-6};
  model.solver.max_outer = 1;
  const Run run = run_alone(box_mesh(ElementType::tet4), model);
  REQUIRE(run.result().status == Status::not_converged);
  CHECK(mentions(run.result().message, "; largest is "));
  CHECK(mentions(run.result().message, "no contact node goes to and fro"));
}
