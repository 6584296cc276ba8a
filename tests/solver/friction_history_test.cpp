// SPDX-License-Identifier: BSD-3-Clause
// Slip relative to the previous load step, and load curves: hysteresis, Cattaneo–Mindlin with unloading.
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "half_space.hpp"
#include "nonlinear/outer_loop.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A slab whose top shears it over a floor with friction bound ψ; its sides carry the corresponding shear
/// stress.
Model sheared_slab(Friction::Reference reference) {
  Model model;
  model.materials.push_back({everything(), elastic_law(2.5, 0.25)});  // μ = 1
  model.boundary.push_back(traction(named("left"), {0, 0, -1}));
  model.boundary.push_back(traction(named("right"), {0, 0, 1}));
  for (const char* side : {"front", "back"}) model.boundary.push_back(roller(named(side), 1));
  model.boundary.push_back(moved(named("top"), 3, {0.01, 0, 0}));
  ContactEntry floor;
  floor.on = named("bottom");
  floor.obstacle = ConstantGap{1.0};
  floor.friction = Friction{4e-3, 0.0, reference};
  model.contact.push_back(floor);
  model.solver.tolerance = 1e-9;
  return model;
}

}  // namespace

TEST_CASE("a film's friction runs through a loop where slip is counted from the step before") {
  const Mesh mesh = make_box({{1, 1, 0.5}, {3, 3, 2}, ElementType::hex8});
  // Stress 0.02 d/0.01, limited to ±4e-3: forwards, back to 0, beyond, and forwards again.
  const std::vector<double> moves{0.1, 0.5, 0.4, 0.0, -0.5, 0.5};
  std::vector<double> expected;
  double slid = 0.0;
  for (const double d : moves) {
    const double stress = std::clamp(0.02 * (d - slid), -4e-3, 4e-3);
    slid = d - stress / 0.02;
    expected.push_back(-stress);
  }
  for (const bool restart : {false, true}) {
    Model model = sheared_slab(Friction::Reference::step);
    for (std::size_t i = 0; i < moves.size(); ++i)
      model.steps.push_back(
          {1.0 + static_cast<double>(i),
           {{"boundary[0]", -expected[i]}, {"boundary[1]", -expected[i]}, {"boundary[4]", moves[i]}}});
    const Problem problem = build_problem(mesh, model);
    Part part = distribute(&problem, MPI_COMM_WORLD);
    std::vector<Checkpoint> all;
    RunOptions options;
    options.checkpoint = [&](const Checkpoint& c) { all.push_back(c); };
    Solution solution = solve(part, model.solver, options);
    if (restart) {
      // Restart in the middle of the loop.
      RunOptions rest;
      if (part.node_map.rank == 0) rest.start = &all[all.size() / 2];
      solution = solve(part, model.solver, rest);
      // A load step that is cut after a restart still measures slip from the same origin.
      OuterLoop loop(part, model.solver, rest, 1.0);
      Result result;
      loop.restore(rest.start, result);
      const Vector& origin = loop.state().origin;
      CHECK(part.node_map.any(std::any_of(origin.begin(), origin.end(), [](double v) { return v != 0.0; })));
      CHECK(loop.rest().state.origin == origin);
    }
    CHECK(solution.result.status == Status::converged);
    CHECK(solution.result.by_time);
    REQUIRE(solution.result.load_steps.size() == moves.size());
    for (std::size_t i = 0; i < moves.size(); ++i) {
      CAPTURE(i);
      CHECK(solution.result.load_steps[i].factor == 1.0 + static_cast<double>(i));
      CHECK(solution.result.load_steps[i].friction_force[0] == doctest::Approx(expected[i]).epsilon(1e-6));
    }
  }
  // Slip relative to the start has no hysteresis.
  Model model = sheared_slab(Friction::Reference::start);
  model.steps = {{1.0, {{"boundary[0]", 0.0}, {"boundary[1]", 0.0}, {"boundary[4]", 0.5}}},
                 {2.0, {{"boundary[4]", 0.0}}}};
  Part part;
  const Solution solution = solve_everywhere(build_problem(mesh, model), model, part);
  CHECK(solution.result.status == Status::converged);
  CHECK(std::abs(solution.result.friction_force[0]) < 1e-9);
}

TEST_CASE("Cattaneo and Mindlin in 3D: pressed, dragged and let back, stick to a cell") {
  const int n = 6;
  const HalfSpace space{n};
  const double ball = 50.0, coefficient = 0.5;
  const Law law = elastic_law(1.0, 0.45);
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(roller(named("front"), 1));
  model.boundary.push_back(moved(named("left"), 3, {0.006, 0, 0}));
  model.boundary.push_back(moved(named("right"), 3, {0.006, 0, 0}));
  model.boundary.push_back(moved(named("back"), 3, {0.006, 0, 0}));
  model.boundary.push_back(moved(named("top"), 3, {0.006, 0, 0}));
  Sphere sphere;
  sphere.radius = ball;
  sphere.centre = {0.0, 0.0, 1.0 / ball - ball};
  sphere.direction = Vector3{0.0, 0.0, -1.0};
  model.contact.push_back({box({-HalfSpace::fine, 0, 0}, {HalfSpace::fine, HalfSpace::fine, 0}), sphere,
                           Friction{0.0, coefficient, Friction::Reference::step}});
  const auto drag = [](double factor) {
    std::map<std::string, double> factors;
    for (int k = 1; k <= 4; ++k) factors["boundary[" + std::to_string(k) + "]"] = factor;
    return factors;
  };
  model.steps = {{1.0, {{"contact[0]", 1.0}}}, {2.0, drag(1.0)}, {3.0, drag(0.4)}};
  for (const std::size_t steps : {2U, 3U}) {
    Model some = model;
    some.steps.resize(steps);
    Part part;
    const Solution solution = solve_everywhere(build_problem(space.half(), some), some, part);
    REQUIRE(solution.result.status == Status::converged);
    const auto& history = solution.result.load_steps;
    const double force = 2 * solution.result.contact_force[2];
    const double a = std::cbrt(0.75 * force * ball / plane_modulus(law));
    const auto ratio = [&](std::size_t i) {
      return std::abs(history[i].friction_force[0]) / (coefficient * history[i].contact_force[2]);
    };
    double stick = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i)
      if (solution.contact_status[i] == ContactStatus::stick) stick += part.contact[i].mass;
    stick = std::sqrt(2 * part.node_map.sum_all(stick) / std::numbers::pi);
    CAPTURE(ratio(1));
    CHECK(ratio(0) < 1e-6);
    CHECK(ratio(1) > 0.3);
    CHECK(ratio(1) < 0.8);
    double gone = ratio(1);
    if (steps == 3) {
      const double back =
          history[2].friction_force[0] * history[1].friction_force[0] > 0 ? ratio(2) : -ratio(2);
      gone = 0.5 * (ratio(1) - back);
    }
    CAPTURE(gone);
    CHECK(std::abs(stick - a * std::cbrt(1 - gone)) < 1.0 / n);
  }
}
