// SPDX-License-Identifier: BSD-3-Clause
// The certificate detects every kind of error in a state, and no run is reported as converged that is not.
#include "contact/certificate.hpp"

#include <doctest/doctest.h>

#include <numeric>

#include "../sanitized.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

constexpr double tolerance = 1e-9;

/// A solved problem whose state a test can perturb and certify again.
struct Solved {
  Run run;
  Space space;
  Traces traces;
  ContactState state;

  explicit Solved(Run solved) : run(std::move(solved)), space(run.part), traces(run.part) {
    const auto& points = run.part.contact;
    state.u = run.solution.displacement;
    state.lambda = ContactValues(points.size());
    state.lambda.normal = run.solution.pressure;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(points[i].tangents); ++k)
        for (std::size_t c = 0; c < 3; ++c)
          state.lambda.tangential[2 * i + k] -= run.solution.traction[i][c] * points[i].tangent[k][c];
      state.bound.push_back(points[i].tresca);
      state.gap.push_back(points[i].gap);
    }
    state.trace = ContactValues(points.size());
    traces.evaluate(state.u, state.trace);
  }

  Certificate certify() {
    traces.evaluate(state.u, state.trace);
    Vector internal(state.u.size());
    reference::residual(run.part.body(), state.u, internal);
    Vector g(run.part.body().secant_count()), diagonal(internal.size());
    reference::secant(run.part.body(), Vector(internal.size(), 0.0), g);
    reference::diagonal(run.part.body(), g, diagonal);
    const std::vector<float> stiffness(diagonal.begin(), diagonal.end());
    const double energy = reference::energy(run.part.body(), state.u);
    return kkt_residuals(space, traces, state, {run.part.load, internal, energy, stiffness}).certificate;
  }
  /// Returns a contact point with this status, under pressure or not.
  std::size_t find(ContactStatus status, bool pressed) const {
    std::size_t i = 0;
    while (run.solution.contact_status[i] != status || (run.solution.pressure[i] > 1e-3) != pressed) ++i;
    return i;
  }
};

Solved solved_beam(double tresca) {
  Model model = beam(2, logarithmic_law(0.01), 0.05, tresca);
  model.solver.tolerance = tolerance;
  return Solved(run_alone(beam_mesh(2, 8), model));
}

}  // namespace

TEST_CASE("a solved state certifies itself, by the numbers the run reports") {
  Solved beam = solved_beam(0.01);
  REQUIRE(beam.run.result().status == Status::converged);
  const Certificate again = beam.certify(), told = beam.run.result().certificate;
  CHECK(again.worst() <= tolerance);
  CHECK(again.equilibrium == doctest::Approx(told.equilibrium).epsilon(1e-2).scale(tolerance));
  CHECK(again.duality_gap == doctest::Approx(told.duality_gap).epsilon(1e-2).scale(tolerance));
}

TEST_CASE("each fault shows in its entry") {
  Solved beam = solved_beam(0.01);
  const double pressure = beam.run.result().max_contact_pressure;
  const std::size_t stick = beam.find(ContactStatus::stick, true),
                    slip = beam.find(ContactStatus::slip, true);
  SUBCASE("a free node moved") {
    std::size_t i = beam.state.u.size() / 2;
    while (beam.run.part.held[i]) ++i;
    beam.state.u[i] += 1e-3;
    const Certificate c = beam.certify();
    CHECK(c.equilibrium > 1e-4);
    CHECK(c.duality_gap > 1e-5);
  }
  SUBCASE("a node pushed into the obstacle") {
    const ContactPoint& point = beam.run.part.contact[stick];
    beam.state.u[2 * static_cast<std::size_t>(point.node) + 1] -= 1e-3;
    const Certificate c = beam.certify();
    double largest = 0.0;
    for (const double u : beam.state.u) largest = std::max(largest, std::abs(u));
    // Its scale is at most the largest displacement, and at least a thousandth of it.
    CHECK(c.penetration >= 0.999e-3 / largest);
    CHECK(c.penetration <= 1.001 / largest);
    CHECK(c.complementarity > 1e-6);
  }
  SUBCASE("an obstacle that pulls") {
    beam.state.lambda.normal[stick] = -0.1 * pressure;
    const Certificate c = beam.certify();
    CHECK(c.tension == doctest::Approx(0.1).epsilon(1e-6));
    CHECK(c.equilibrium > 1e-4);
  }
  SUBCASE("pressure across a gap") {
    const std::size_t open = std::max_element(beam.run.solution.gap.begin(), beam.run.solution.gap.end()) -
                             beam.run.solution.gap.begin();
    REQUIRE(beam.run.solution.gap[open] > 1e-6);
    beam.state.lambda.normal[open] = pressure;
    CHECK(beam.certify().complementarity > 1e-8);
    CHECK(beam.certify().tension == 0.0);
  }
  SUBCASE("friction beyond its bound") {
    beam.state.lambda.tangential[2 * slip] *= 1.5;
    CHECK(beam.certify().friction_cone == doctest::Approx(0.5 * 0.01 / pressure).epsilon(1e-3));
  }
  SUBCASE("friction along the slip") {
    // The error in the work is largest where the slip is longest.
    const auto& slips = beam.state.trace.tangential;
    const std::size_t most = std::max_element(slips.begin(), slips.end(),
                                              [](double a, double b) { return std::abs(a) < std::abs(b); }) -
                             slips.begin();
    beam.state.lambda.tangential[most] *= -1.0;
    const Certificate c = beam.certify();
    CHECK(c.friction_cone < tolerance);
    CHECK(c.complementarity > 1e-4);
    CHECK(c.equilibrium > 1e-4);
  }
  SUBCASE("a node that sticks, moved") {
    const ContactPoint& point = beam.run.part.contact[stick];
    beam.state.u[2 * static_cast<std::size_t>(point.node)] += 1e-3;
    CHECK(beam.certify().complementarity > 1e-6);
  }
  SUBCASE("all multipliers forgotten") {
    std::fill(beam.state.lambda.normal.begin(), beam.state.lambda.normal.end(), 0.0);
    CHECK(beam.certify().equilibrium > 0.1);
  }
}

TEST_CASE("a state that is not a number is the worst of all") {
  Solved beam = solved_beam(0.0);
  beam.state.u[100] = NAN;
  CHECK(std::isinf(beam.certify().worst()));
}

TEST_CASE("a run that is cut short says so") {
  Model model = beam(2, logarithmic_law(0.01), 0.05, 0.01);
  for (const int steps : {1, 2}) {
    model.solver.max_outer = steps;
    const Run run = run_alone(beam_mesh(2, 8), model);
    CHECK(run.result().status == Status::not_converged);
    CHECK(run.result().outer_iterations == steps);
    CHECK(run.result().certificate.worst() > model.solver.tolerance);
    CHECK(mentions(run.result().message, "above the tolerance"));
    CHECK(run.result().r.size() == static_cast<std::size_t>(steps));
  }
}

TEST_CASE("the paper's stop by steps with its r* ends far from the solution, and is not called converged" *
          doctest::skip(sanitized)) {
  Model model = beam(2, elastic_law(1.0, 0.3), 0.05);
  model.solver.stop = SolverOptions::Stop::paper;
  model.solver.penalty = SolverOptions::Penalty::paper;
  model.solver.contact = SolverOptions::Contact::admm;
  model.solver.tolerance = 1e-5;
  const Run early = run_alone(beam_mesh(2, 16), model);
  CHECK(early.result().status == Status::not_converged);
  CHECK(early.result().certificate.worst() > 10 * model.solver.tolerance);
  CHECK(mentions(early.result().message, "the step was small, the error is not"));
  // The same iteration with the residual-based stop takes far longer and is correct.
  model.solver.stop = SolverOptions::Stop::kkt;
  model.solver.tolerance = 1e-6;
  model.solver.relaxation = 1.0;
  const Run exact = run_alone(beam_mesh(2, 16), model);
  CHECK(exact.result().status == Status::converged);
  CHECK(exact.result().contact_iterations > 3 * early.result().contact_iterations);
  CHECK(distance(early.probe(), exact.probe()) > 1e-5 * length(exact.probe()));
}

TEST_CASE("a body moved without strain, short of the obstacle, is certified") {
  Model model;
  model.materials.push_back({Selector{}, elastic_law(1.0, 0.3)});
  BoundaryEntry top;
  top.on = {Selector::Kind::name, "top", {}, {}};
  top.displacement = std::array<std::optional<double>, 3>{0.0, -0.02, std::nullopt};
  model.boundary.push_back(top);
  ContactEntry bottom;
  bottom.on = {Selector::Kind::name, "bottom", {}, {}};
  bottom.obstacle = ConstantGap{0.03};
  model.contact.push_back(bottom);
  const Run run = run_alone(make_box({{1, 1, 1}, {6, 6, 1}, ElementType::tri3}), model);
  CHECK(run.solution.result.status == Status::converged);
  CHECK(run.solution.result.active_nodes == 0);
  for (std::size_t i = 1; i < run.solution.displacement.size(); i += 2)
    CHECK(run.solution.displacement[i] == doctest::Approx(-0.02));
}

namespace {

/// A beam clamped at one end, on a plane, whose free half has `ratio` times the stiffness of the other half.
Run half_stiffened(double ratio, double soft = 1.0) {
  Model model = beam(3, elastic_law(soft, 0.3), 1e-4 * soft);
  MaterialEntry stiff{Selector{}, elastic_law(ratio * soft, 0.3)};
  stiff.on.kind = Selector::Kind::box;
  stiff.on.lower = {2, 0, 0};
  stiff.on.upper = {4, 1, 1};
  model.boundary[1].on.lower[0] = 0.0;  // the soft half bends, and the stiff half tilts on its edge
  model.materials.push_back(stiff);
  return run_alone(make_box({{4, 1, 1}, {8, 2, 2}, ElementType::tet4}), model);
}

}  // namespace

TEST_CASE("a part as stiff as rigid makes no wrong state look right") {
  const Vector3 rigid = half_stiffened(1e7).result().contact_force;
  REQUIRE(length(rigid) > 0.0);
  bool limited = false;
  for (double ratio = 1e7; ratio < 1e29; ratio *= 100.0) {
    INFO(ratio);
    const Run run = half_stiffened(ratio);
    const Certificate& c = run.result().certificate;
    // Beyond a ratio of 1e7 results change only by the inverse of the ratio.
    if (run.result().status == Status::converged)
      CHECK(distance(run.result().contact_force, rigid) <= 1e-5 * length(rigid));
    else
      limited = true;
    CHECK((run.result().status == Status::converged) == c.meets(1e-6));
    CHECK(c.rounding.worst() >= 1e-16 * ratio);
    if (run.result().status == Status::limited_by_rounding) {
      CHECK(c.rounding.worst() > 1e-6);
      CHECK(mentions(run.result().message, "can be known to"));
    }
  }
  CHECK(limited);
}

TEST_CASE("what single precision cannot hold is refused, whatever else is small") {
  for (const double ratio : {1e65, 1e80}) {
    INFO(ratio);
    CHECK_THROWS_WITH_AS(half_stiffened(ratio, 1e-40), doctest::Contains("which single precision holds"),
                         InputError);
  }
  CHECK(half_stiffened(1e39).result().status != Status::converged);
}

TEST_CASE("maxima keep what is no number, and rounding counts as much as the residual") {
  Certificate c;
  CHECK(c.meets(0.0));
  c.tension = NAN;
  CHECK(std::isinf(c.worst()));
  CHECK_FALSE(c.meets(1.0));
  CHECK_FALSE(c.exhausted(1.0));
  c.tension = 0.0;
  c.equilibrium = 1e-5;
  c.rounding.equilibrium = 1e-4;
  CHECK_FALSE(c.meets(1e-6));
  CHECK(c.exhausted(1e-6));
  CHECK_FALSE(c.meets(1e-4));  // the true residual may exceed it
  CHECK(c.meets(1.1e-4 * (1 + 1e-15)));
  c.penetration = 1e-5;
  CHECK_FALSE(c.exhausted(1e-6));
}
