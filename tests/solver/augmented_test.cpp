// SPDX-License-Identifier: BSD-3-Clause
// The augmented Lagrangian method: its contact potential, its line search, and its converged solution.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "contact/augmented.hpp"
#include "nonlinear/line_search.hpp"
#include "nonlinear/outer_loop.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A state with open, closed, sticking and slipping points, the same on every call.
ContactState some_state(const Part& part) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1, 1);
  ContactState state;
  const std::size_t points = part.contact.size();
  state.lambda = state.trace = ContactValues(points);
  for (std::size_t i = 0; i < points; ++i) {
    state.lambda.normal[i] = std::max(value(random), 0.0);
    state.trace.normal[i] = value(random);
    for (std::size_t k = 0; k < 2; ++k) {
      state.lambda.tangential[2 * i + k] = 0.3 * value(random);
      state.trace.tangential[2 * i + k] = value(random);
    }
    state.gap.push_back(0.1 * value(random));
    state.bound.push_back(1.0 + value(random));
  }
  return state;
}

}  // namespace

TEST_CASE("multipliers are the derivative of what contact adds, and the stiffness theirs") {
  Model model = elastic_model();
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.5));
  const Problem problem = build_problem(box_mesh(ElementType::tet4), model);
  const Part part = distribute(&problem, MPI_COMM_SELF);
  const Traces traces(part);
  const ContactState state = some_state(part);
  const AugmentedContact contact(traces, state, 1.7);
  const ContactValues at = contact.multipliers(state.trace);
  const ActiveSet set = contact.derivative(state.trace);
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    const double mass = part.contact[i].mass;
    ContactValues more = state.trace, less = state.trace;
    more.normal[i] += h;
    less.normal[i] -= h;
    CHECK((contact.value(more) - contact.value(less)) / (2 * h) ==
          doctest::Approx(mass * at.normal[i]).scale(1.0).epsilon(1e-7));
    const double stiff =
        (contact.multipliers(more).normal[i] - contact.multipliers(less).normal[i]) / (2 * h);
    CHECK(stiff == doctest::Approx(set.held[i].normal ? contact.penalty() : 0.0).scale(1.0).epsilon(1e-7));
    for (std::size_t k = 0; k < 2; ++k) {
      more = less = state.trace;
      more.tangential[2 * i + k] += h;
      less.tangential[2 * i + k] -= h;
      CHECK((contact.value(more) - contact.value(less)) / (2 * h) ==
            doctest::Approx(mass * at.tangential[2 * i + k]).scale(1.0).epsilon(1e-7));
      const double along = set.slip_direction[2 * i + k];
      const double turning =
          set.held[i].tangential ? contact.penalty() : set.slip_stiffness[i] * (1.0 - along * along);
      const double found = (contact.multipliers(more).tangential[2 * i + k] -
                            contact.multipliers(less).tangential[2 * i + k]) /
                           (2 * h);
      CHECK(found == doctest::Approx(turning).scale(1.0).epsilon(1e-6));
    }
  }
}

TEST_CASE("a step is found where the slope of a convex function is gone, whatever its scales") {
  // Slopes that vanish at `wall` and rise a million times as steeply beyond; below, slopes that follow a
  // power.
  for (const double wall : {0.9, 0.1, 1e-3}) {
    CAPTURE(wall);
    int asked = 0;
    const auto slope = [&](double t) {
      ++asked;
      return t < wall ? t / wall - 1.0 : 1e6 * (t - wall);
    };
    const double t = find_step(-1.0, slope);
    CHECK(t == doctest::Approx(wall).epsilon(0.6));
    CHECK(std::abs(slope(t)) <= 0.5);
    CHECK(asked <= 21);
  }
  CHECK(find_step(-1.0, [](double t) { return std::pow(t, 0.02) - 1.5; }) == 1.0);
  CHECK(find_step(-1.0, [](double t) { return 0.1 * t; }) == 1.0);
  // Extrapolation reaches `longest` at most, and goes no further than the slope requires.
  CHECK(find_step(-1.0, [](double t) { return std::pow(t, 0.02) - 1.9; }, {.longest = 100.0}) == 100.0);
  for (const double far : {3.0, 50.0, 7e3}) {
    CAPTURE(far);
    const auto slope = [&](double t) { return std::pow(t / far, 0.1) - 1.0; };
    CHECK(std::abs(slope(find_step(-1.0, slope, {.longest = 1e6}))) <= 0.5);
  }
}

TEST_CASE("the method of multipliers alone comes to the answer of the others") {
  for (const double coulomb : {0.0, 0.4}) {
    CAPTURE(coulomb);
    Model model = beam(3, logarithmic_law(0.01), 0.02, coulomb > 0.0 ? 0.0 : 0.01);
    if (coulomb > 0.0) model.contact[0].friction = Friction{0.0, coulomb};
    model.solver.tolerance = 1e-7;
    const Run other = run_alone(beam_mesh(3, 2), model);
    REQUIRE(other.result().status == Status::converged);
    Tuning tuning;  // every Newton step counts as a stall, and no retreat ends
    tuning.patience = 1;
    tuning.progress = 0.0;
    tuning.retreat_gain = 0.0;
    tuning.first_retreat = 100;
    const RunOptions run;
    OuterLoop loop(other.part, model.solver, run, 1.0, tuning);
    Result result;
    CHECK(loop.run(result));
    CHECK(loop.certify().certificate.worst() <= model.solver.tolerance);
    CHECK_FALSE(loop.gave_up());
    CHECK(result.outer_iterations <= 40);
    double most = 0.0, size = 0.0;
    for (std::size_t i = 0; i < loop.state().u.size(); ++i) {
      most = std::max(most, std::abs(loop.state().u[i] - other.solution.displacement[i]));
      size = std::max(size, std::abs(other.solution.displacement[i]));
    }
    CHECK(most < 1e-5 * size);
  }
}
