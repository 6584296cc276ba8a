// SPDX-License-Identifier: BSD-3-Clause
// The parts of the outer loop, each alone with made-up numbers; the schedule of preconditioners; the
// augmented Lagrangian method.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "contact/augmented.hpp"
#include "linear/load_path.hpp"
#include "nonlinear/accuracy.hpp"
#include "nonlinear/contact_preconditioner.hpp"
#include "nonlinear/friction_bounds.hpp"
#include "nonlinear/line_search.hpp"
#include "nonlinear/loop_control.hpp"
#include "nonlinear/outer_loop.hpp"
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

const Tuning usual;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Copies an object through the numbers that a checkpoint stores.
template <class T>
T copied_by_visit(T from, T blank) {
  std::map<std::string, double> numbers;
  from.visit([&](const char* name, auto& value) { numbers[name] = static_cast<double>(value); });
  blank.visit([&](const char* name, auto& value) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(numbers.at(name));
  });
  return blank;
}

Residuals residuals(double worst) {
  Residuals r;
  r.certificate.equilibrium = worst;
  r.scales = {2.0, 2.0, 3.0, 3.0, {}};
  return r;
}

}  // namespace

TEST_CASE("linearisation: the secant far off, the tangent near, and never for a linear body") {
  using Outer = SolverOptions::Outer;
  const Linearisation both(Outer::automatic, false, usual);
  CHECK(!both.takes_tangent(1.01 * usual.first_reach));
  CHECK(both.takes_tangent(0.99 * usual.first_reach));
  CHECK(Linearisation(Outer::newton, false, usual).takes_tangent(1e3));
  CHECK(!Linearisation(Outer::kacanov, false, usual).takes_tangent(1e-9));
  for (const Outer outer : {Outer::automatic, Outer::newton})
    CHECK(!Linearisation(outer, true, usual).takes_tangent(1e-9));
}

TEST_CASE("linearisation: a tangent that went too far is trusted less, down to a floor") {
  Linearisation l(SolverOptions::Outer::automatic, false, usual);
  l.after_tangent(0.2, 0.19);
  CHECK(l.reach() == usual.first_reach);
  l.after_tangent(0.2, 0.21);
  CHECK(l.reach() == doctest::Approx(0.2 * usual.reach_cut));
  CHECK(copied_by_visit(l, Linearisation(SolverOptions::Outer::automatic, false, usual)).reach() ==
        l.reach());
  l.after_tangent(0.08, not_a_number);
  CHECK(l.reach() == doctest::Approx(0.08 * usual.reach_cut));
  l.after_tangent(1e-6, 1.0);
  CHECK(l.reach() == usual.least_reach);
  l.start_again();
  CHECK(l.reach() == usual.first_reach);
}

TEST_CASE(
    "damping: a quadratic energy takes whole steps, a stiffer one shorter ones, and it comes to an end") {
  CHECK(!shorter_step(1.0, 2.0, 2.0));
  CHECK(!shorter_step(1.0, 2.9, 2.0));
  CHECK(*shorter_step(1.0, 4.0, 2.0) == doctest::Approx(0.5));
  CHECK(*shorter_step(0.5, 3.01, 2.0) == doctest::Approx(0.5 * 2.0 / 3.01));
  CHECK(*shorter_step(1.0, 1e9, 2.0) == doctest::Approx(0.1));
  CHECK(*shorter_step(1.0, not_a_number, 2.0) == doctest::Approx(0.1));
  // A body of stiffness 1 near the start and 100 beyond: the soft model predicts δ = 1.
  const auto work = [](double t) { return t < 0.01 ? t : 0.01 + 100.0 * (t - 0.01); };
  double t = 1.0;
  int trials = 0;
  while (const auto next = shorter_step(t, work(t), 1.0)) {
    CHECK(*next < t);
    t = *next;
    ++trials;
  }
  CHECK(trials <= usual.max_damping_trials);
  CHECK(work(t) <= 1.5);
}

TEST_CASE("fallback: steps that make progress never retreat") {
  Fallback fallback(usual);
  double worst = 1.0;
  for (int i = 0; i < 100; ++i) CHECK(!fallback.after_newton(worst *= 0.69, true));
  CHECK(!fallback.retreating());
}

TEST_CASE("fallback: a stall, a failed solve and a breakdown retreat, each time for longer") {
  Fallback fallback(usual);
  CHECK(!fallback.after_newton(1.0, true));
  for (int i = 1; i < usual.patience; ++i) CHECK(!fallback.after_newton(0.9, true));
  CHECK(fallback.after_newton(0.9, true));
  int expected = usual.first_retreat;
  for (const double worst : {0.5, 0.5, HUGE_VAL}) {
    int steps = 0;
    for (; fallback.retreating(); ++steps) fallback.after_fallback_step(1e3);
    CHECK(steps == expected);
    expected *= 2;
    CHECK(fallback.after_newton(worst, std::isinf(worst)));
  }
  // The longest retreat.
  for (int i = 0; i < 20; ++i) fallback.after_newton(1.0, false);
  int steps = 0;
  for (; fallback.retreating(); ++steps) fallback.after_fallback_step(1e3);
  CHECK(steps == usual.first_retreat << usual.most_doublings);
}

TEST_CASE("fallback: steps without a gain are counted, and those without a solution for more") {
  for (const bool solved : {true, false}) {
    Fallback fallback(usual);
    fallback.after_newton(1.0, false);
    int steps = 0;
    for (; !fallback.stuck(); ++steps) fallback.after_fallback_step(1.0, solved);
    CHECK(steps == usual.most_idle / (solved ? 1 : usual.unsolved_worth));
  }
}

TEST_CASE("fallback: ADMM hands back once it is well below the best Newton step") {
  Fallback fallback(usual);
  fallback.after_newton(0.4, true);
  fallback.after_newton(0.6, false);
  REQUIRE(fallback.retreating());
  Fallback copy = copied_by_visit(fallback, Fallback(usual));
  for (Fallback* each : {&fallback, &copy}) {
    each->after_fallback_step(0.5 * 0.4);
    CHECK(each->retreating());
    each->after_fallback_step(0.99 * usual.retreat_gain * 0.4);
    CHECK(!each->retreating());
  }
}

TEST_CASE("penalties: the first one goes with 1/λ_min and the root of the mesh width") {
  const double one = first_penalty(0.5, 100, 3, usual);
  CHECK(first_penalty(0.25, 100, 3, usual) == doctest::Approx(2.0 * one));
  CHECK(first_penalty(0.5, 1600, 3, usual) == doctest::Approx(0.5 * one));
  CHECK(first_penalty(0.5, 400, 2, usual) == doctest::Approx(0.5 * first_penalty(0.5, 100, 2, usual)));
  CHECK(first_penalty(0.0, 100, 3, usual) == 1.0);
}

TEST_CASE("penalties: each rule begins with its own, and only the automatic one moves") {
  SolverOptions options;
  const std::array<BalanceSample, 8> behind{BalanceSample{{1.0, 1.0}, {1e-3, 1e-3}}};
  const Scales scales{1.0, 1.0, 1.0, 1.0, {}};
  const auto chosen = [&](SolverOptions::Penalty rule) {
    options.penalty = rule;
    options.r = rule == SolverOptions::Penalty::automatic ? 0.0 : 7.0;
    PenaltyControl control(options, 3.0, usual);
    CHECK(!control.chosen());
    control.choose(5.0, 0.1);
    CHECK(control.chosen());
    CHECK(control.value().normal == control.value().tangential);
    return control;
  };
  using Rule = SolverOptions::Penalty;
  for (const auto& [rule, r] : {std::pair{Rule::fixed, 7.0}, {Rule::paper, 5.0}, {Rule::automatic, 3.0}}) {
    PenaltyControl control = chosen(rule);
    CHECK(control.value().normal == r);
    CHECK(control.balance(behind, scales) == (rule == Rule::automatic));
    CHECK((control.value().normal != r) == (rule == Rule::automatic));
    if (rule == Rule::automatic) {
      CHECK(control.go_back_to_first());
      CHECK(control.value().normal == r);
    }
  }
  options.stop = SolverOptions::Stop::paper;
  CHECK(!chosen(Rule::automatic).balance(behind, scales));
}

TEST_CASE(
    "penalties: up where held rows are behind, down where free ones are, by no more than e and within "
    "bounds") {
  PenaltyControl control(SolverOptions(), 3.0, usual);
  const Scales scales{1.0, 1.0, 1.0, 1.0, {}};
  const auto after = [&](const std::vector<BalanceSample>& samples, double lambda_min = 0.1) {
    control.choose(0.0, lambda_min);
    control.balance(samples, scales);
    return control.value();
  };
  // Closed rows of N lag in the primal residual, open rows of T in the dual one.
  const BalanceSample sample{{4e-3, 1e-3}, {1e-3, 4e-3}};
  const Penalty many = after(std::vector<BalanceSample>(6, sample));
  CHECK(many.normal > 3.0);
  CHECK(many.tangential < 3.0);
  CHECK(many.normal == doctest::Approx(3.0 * 2.0));
  // Fewer iterations carry less weight.
  const Penalty one = after({sample});
  CHECK(one.normal > 3.0);
  CHECK(one.normal < many.normal);
  // No residual on the other side.
  const Penalty most = after(std::vector<BalanceSample>(6, BalanceSample{{1.0, 1.0}, {0.0, 0.0}}));
  CHECK(most.normal == doctest::Approx(3.0 * std::exp(1.0)));
  // Bounds, and no samples.
  CHECK(after(std::vector<BalanceSample>(6, sample), 10.0).normal ==
        doctest::Approx(usual.largest_penalty / 10.0));
  CHECK(after({}).normal == 3.0);
  control.choose(0.0, 0.0);
  CHECK(!control.balance(std::vector<BalanceSample>(6, sample), scales));
}

TEST_CASE("accuracy: ADMM is solved below the residuals before it, but not far below the tolerance") {
  SolverOptions options;
  options.tolerance = 1e-6;
  const auto reach = [&](double worst) {
    return admm_accuracy(options, residuals(worst), false, usual).force_tolerance / 2.0;
  };
  CHECK(reach(1e-2) == doctest::Approx(usual.inner_reduction * 1e-2));
  CHECK(reach(50.0) == doctest::Approx(usual.inner_reduction));
  CHECK(reach(1e-7) == doctest::Approx(0.5e-6));
  const AdmmOptions later = admm_accuracy(options, residuals(1e-2), false, usual);
  CHECK(later.trace_tolerance / 3.0 == doctest::Approx(later.force_tolerance / 2.0));
  CHECK(later.max_iterations == usual.balancing_iterations);
  // The opening phase provides a start for Newton steps, if these follow.
  const AdmmOptions opening = admm_accuracy(options, residuals(1e-2), true, usual);
  CHECK(opening.max_iterations == usual.opening_iterations);
  CHECK(opening.sticking);
  CHECK_FALSE(later.sticking);
  options.contact = SolverOptions::Contact::admm;
  const AdmmOptions alone = admm_accuracy(options, residuals(1e-2), true, usual);
  CHECK(alone.max_iterations == options.max_contact);
  CHECK_FALSE(alone.sticking);
  options.contact = SolverOptions::Contact::automatic;
  options.max_contact = 2;
  CHECK(admm_accuracy(options, residuals(1e-2), false, usual).max_iterations == 2);
  // No scale yet: accuracy relative to the first forces.
  Residuals rest;
  const AdmmOptions at_rest = admm_accuracy(options, rest, true, usual);
  CHECK(at_rest.force_reduction == usual.inner_reduction);
  CHECK(std::isinf(at_rest.trace_tolerance));
  // The paper's stopping criterion and its relaxation.
  CHECK(at_rest.relaxation == 1.7);
  options.penalty = SolverOptions::Penalty::paper;
  CHECK(admm_accuracy(options, rest, true, usual).relaxation == 1.0);
  options.relaxation = 1.3;
  CHECK(admm_accuracy(options, rest, true, usual).relaxation == 1.3);
  options.stop = SolverOptions::Stop::paper;
  CHECK(admm_accuracy(options, residuals(1e-2), false, usual).step_tolerance == options.tolerance);
}

TEST_CASE(
    "accuracy: a Newton step that ends near the tolerance is solved as the last, and caps are the user's") {
  SolverOptions options;
  options.tolerance = 1e-6;
  options.max_cg = 17;
  const CgOptions far = newton_accuracy(options, residuals(1e-2), usual);
  CHECK(far.relative == usual.solve_reduction);
  const double last = usual.last_share * 1e-6 * 2.0, reached = usual.last_reach * last;
  CHECK(far.target(0.99 * reached / usual.solve_reduction) == doctest::Approx(last));
  CHECK(far.target(1.01 * reached / usual.solve_reduction) == doctest::Approx(1.01 * reached));
  CHECK(far.most == doctest::Approx(1e-2 * 2.0));
  CHECK(far.absolute == doctest::Approx(usual.last_share * 1e-6 * 2.0));
  CHECK(far.max_iterations == 17);
  const AugmentedAccuracy augmented = augmented_accuracy(options, residuals(1e-2), usual);
  CHECK(augmented.force == far.absolute);
  CHECK(augmented.solve.absolute == 0.5 * far.absolute);
  CHECK(augmented.solve.max_iterations == 17);
  CHECK(digits_left(options, residuals(1e-2), usual) == doctest::Approx(4.0 - std::log10(usual.last_share)));
  CHECK(digits_left(options, residuals(1e-7), usual) == 0.0);
  CHECK(admm_accuracy(options, residuals(1e-2), false, usual).max_cg == 17);
}

TEST_CASE("accuracy: residuals fall further where the duality gap is behind them") {
  Certificate c;
  CHECK(gap_share(c) == 1.0);
  c.equilibrium = 1e-4;
  c.duality_gap = 1e-5;
  CHECK(gap_share(c) == 1.0);
  c.duality_gap = 1e-2;
  CHECK(gap_share(c) == doctest::Approx(1e-2));
  c.duality_gap = 1e5;
  CHECK(gap_share(c) == 1e-4);
  c.duality_gap = HUGE_VAL;
  CHECK(gap_share(c) == 1.0);
}

namespace {

/// Two nodes in 2D: one on an obstacle that penetrates the body by 0.3 and pushed towards it by 0.1, one at
/// distance 0.5 from another obstacle.
Part two_nodes() {
  Part part;
  part.type = ElementType::tri3;
  part.coordinates = {0.0, 0.0, 1.0, 0.0};
  part.node_index = {0, 1};
  part.node_map.owned = 2;
  part.held = {0, 1, 0, 0};
  part.load = {{0, 4.0}, {2, -6.0}};
  part.prescribed = {{1, -0.1}};
  ContactPoint in, away;
  in.normal = away.normal = {0.0, -1.0, 0.0};
  in.gap = -0.3 - 0.1;  // as in build_problem, which subtracts the prescribed displacement
  in.mass = away.mass = 1.0;
  away.node = 1;
  away.entry = 1;
  away.gap = 0.5;
  away.tresca = 0.2;
  away.coulomb = 0.3;
  away.tangents = 1;
  for (const ContactPoint& point : {in, away}) {
    const RowEntry entry{point.node, point.normal, point.normal, {}};
    part.contact.push_back(point, {&entry, 1});
  }
  part.owned_contact = 2;
  return part;
}

}  // namespace

TEST_CASE("load path: the full load is the part's to the bit, on the way and after it") {
  const Part part = two_nodes();
  LoadPath path(part);
  const auto is_full = [&] {
    CHECK(std::equal(path.load().begin(), path.load().end(), part.load.begin(), part.load.end()));
    CHECK(std::equal(path.prescribed().begin(), path.prescribed().end(), part.prescribed.begin(),
                     part.prescribed.end()));
    REQUIRE(path.gap().size() == 2);
    for (std::size_t i = 0; i < 2; ++i) CHECK(path.gap()[i] == part.contact[i].gap);
  };
  is_full();
  path.go_to(0.3);
  CHECK(path.share() == 0.3);
  path.go_to(1.0);
  is_full();
}

TEST_CASE("load path: a share of forces, displacements and indentation; open gaps stay") {
  const Part part = two_nodes();
  LoadPath path(part);
  for (const double share : {0.25, 0.7, 1.5}) {
    path.go_to(share);
    std::vector<double> f(4, 1.0), u(4, 1.0);
    path.add_load(f);
    path.prescribe(u);
    CHECK(f[0] == doctest::Approx(1.0 + 4.0 * share));
    CHECK(f[1] == 1.0);
    CHECK(f[2] == doctest::Approx(1.0 - 6.0 * share));
    CHECK(u == std::vector<double>{1.0, -0.1 * share, 1.0, 1.0});
    // At zero load the first obstacle just touches.
    CHECK(path.gap()[0] == doctest::Approx(-0.4 * share));
    CHECK(path.gap()[1] == 0.5);
  }
}

TEST_CASE("friction bounds follow the pressure, and say by how much") {
  const Part part = two_nodes();
  CHECK(has_friction(part));
  Vector bound(2, 0.0);
  CHECK(follow_pressure(part, {0.0, 0.0}, bound) == 0.0);
  CHECK(bound == Vector{0.0, 0.2});
  CHECK(follow_pressure(part, {5.0, 2.0}, bound) == doctest::Approx(0.3 * 2.0 / 5.0));
  CHECK(bound[1] == doctest::Approx(0.2 + 0.6));
  CHECK(follow_pressure(part, {5.0, 2.0}, bound) == 0.0);
  Part smooth = part;
  for (ContactPoint& point : smooth.contact) point.tangents = 0;
  CHECK(!has_friction(smooth));
}

TEST_CASE(
    "preconditioner: stale without one, fresh after a setup, stale once a step costs what a setup does") {
  const Tuning defaults;
  PreconditionerSchedule schedule(defaults);
  CHECK(schedule.stale());
  schedule.built();
  CHECK(!schedule.stale());
  schedule.watch(2.0, 20);  // the reference: ten iterations per digit
  CHECK(!schedule.stale());
  schedule.watch(0.0, 0);
  schedule.watch(2.0, 20 + static_cast<int>(defaults.setup_worth));
  CHECK(!schedule.stale());
  schedule.watch(1.0, 11 + static_cast<int>(defaults.setup_worth));
  CHECK(schedule.stale());
  CHECK(schedule.stale(1.0));
  CHECK(!schedule.stale(0.9 * defaults.setup_worth / (defaults.setup_worth + 1.0)));  // too little to gain
  schedule.built();
  schedule.watch(2.0, 40);  // a new reference
  CHECK(!schedule.stale());
  schedule.mark_stale();
  CHECK(schedule.stale(0.0));
}

TEST_CASE("preconditioner: the penalty and the active set of its setup, and their change since") {
  const Tuning defaults;
  PreconditionerSchedule schedule(defaults);
  schedule.built_for(Penalty{2.0, 1.0});
  CHECK(!schedule.penalty_moved({2.9 / 3.0 * 2.0, 1.0}, true));
  CHECK(schedule.penalty_moved({2.0 * 1.01 * defaults.penalty_worth, 1.0}, false));
  CHECK(schedule.penalty_moved({2.0, 0.99 / defaults.penalty_worth}, true));
  CHECK(!schedule.penalty_moved({2.0, 0.99 / defaults.penalty_worth}, false));
  ActiveSet set(2);
  set.held[0] = {true, false};
  set.slip_stiffness[0] = 4.0;
  CHECK(schedule.set_moved(set));
  schedule.built_for(set);
  CHECK(!schedule.set_moved(set));
  CHECK(schedule.set_moved(set, 1.0));
  ActiveSet other = set;
  other.held[0].tangential = true;
  CHECK(schedule.set_moved(other));
  other = set;
  for (const double factor : {0.99, 1.01}) {
    other.slip_stiffness[0] = 4.0 * factor * defaults.penalty_worth;
    CHECK(schedule.set_moved(other) == (factor > 1.0));
    other.slip_stiffness[0] = 4.0 / (factor * defaults.penalty_worth);
    CHECK(schedule.set_moved(other) == (factor > 1.0));
  }
  other = set;
  other.slip_stiffness[1] = 0.1;
  CHECK(schedule.set_moved(other));
  schedule.built_for(Penalty{2.0, 1.0});  // sets a penalty, no active set
  CHECK(schedule.set_moved(set));
  CHECK(!schedule.drifted(0.9 * defaults.drift_worth * 8.0, 8.0));
  CHECK(schedule.drifted(1.1 * defaults.drift_worth * 8.0, 8.0));
}

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
