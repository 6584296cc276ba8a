// SPDX-License-Identifier: BSD-3-Clause
// One step of the outer loop: ADMM on the secant, or semismooth Newton on secant or tangent.
#include "nonlinear/step.hpp"

#include <algorithm>
#include <array>

#include <kacanov/corner_dilatation.hpp>
#include <kacanov/reference.hpp>

#include "amg/make_preconditioner.hpp"
#include "contact/active_set_step.hpp"
#include "contact/dual_admm.hpp"
#include "contact/held_nodes.hpp"
#include "linear/free_strain.hpp"
#include "nonlinear/accuracy.hpp"
#include "nonlinear/body_measures.hpp"
#include "nonlinear/line_search.hpp"
#include "nonlinear/linearisation.hpp"
#include "reference/expansion.hpp"

namespace kacanov {
namespace {

/// u += t δ, t as long as damping allows, or as the body wants it. Leaves R(u) and the frozen secant at the
/// new u.
double take_damped(StepContext& c, const ActiveSetStep& step, const HeldNodes& nodes) {
  const Vector& delta = step.delta;
  // The solve is over: its vectors are free.
  Vector &from = c.work.direction, &force = c.work.image, &u = c.state.u;
  from = u;
  force.assign(c.body.internal().begin(), c.body.internal().end());
  const auto go_to = [&](double t) {
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = from[i] + t * delta[i];
    c.path.prescribe(u);  // every iteration of the solve has added its rounding along held directions
    c.body.evaluate_and_freeze(u);
  };
  double t = 1.0;
  for (int trial = 0;; ++trial) {
    go_to(t);
    if (c.body.linear() || trial == c.tuning.max_damping_trials) return t;
    const std::array<double, 2> work = c.space.dot2(delta, c.body.internal(), delta, force);
    const auto shorter = shorter_step(t, work[0] - work[1], step.curvature);
    if (!shorter) break;
    t = *shorter;
  }
  const auto slope_here = [&](double s) {
    Vector& grown = c.work.residual;
    for (std::size_t i = 0; i < u.size(); ++i) grown[i] = c.body.internal()[i] - force[i];
    nodes.subtract_sliding(grown);
    return c.space.dot(delta, grown) + s * step.turning - step.slope;
  };
  const bool closed = step.closing <= c.tuning.closed_rows * c.space.max_abs(delta);
  const LineSearchOptions search{.longest = c.tuning.longest_step};
  if (t < 1.0 || !closed || !(slope_here(1.0) < -search.steep * step.slope)) return t;
  return find_step(
      -step.slope,
      [&](double s) {
        go_to(s);
        return slope_here(s);
      },
      search);
}

/// Whether any point is under pressure. Collective.
bool touches(const StepContext& c) {
  const Vector& pressure = c.state.lambda.normal;
  return c.part.node_map.any(std::any_of(pressure.begin(), pressure.end(), [](double p) { return p > 0.0; }));
}

}  // namespace

StepContext::StepContext(const Part& the_part, const SolverOptions& the_options, const RunOptions& run,
                         const Tuning& the_tuning)
    : part(the_part),
      options(the_options),
      tuning(the_tuning),
      path(the_part),
      space(the_part),
      traces(the_part),
      regions(the_part),
      body(the_part, run.threads, run.instruction_set),
      preconditioner(
          the_part, body,
          make_preconditioner(the_options, the_part, run.threads, run.instruction_set, &body.op().local()),
          the_tuning) {
  refuse_beyond_floats(part, body.diagonal());
  if (regions.count() > 1) {
    weights = std::make_shared<ResidualWeights>(ResidualWeights{regions.of_nodes(), {}});
    space.weigh(weights);
  }
  secant = {&space, &traces,
            [this](std::span<const double> x, std::span<double> y) { return body.op().apply(x, y); },
            [this](std::span<const double> r, std::span<double> z) { preconditioner.apply(r, z); }};
  secant.pull = [this](std::span<double> f) { body.unbalanced(path, f); };
  if (!body.linear())
    secant.unbalanced = [this](std::span<const double> u, std::span<double> f) {
      body.unbalanced(path, u, f);
    };
  tangent = secant;
  tangent.apply = [this](std::span<const double> x, std::span<double> y) {
    return body.op().apply_tangent(x, y);
  };
  if (options.stop == SolverOptions::Stop::paper) volume = lumped_volume(part);
  put_to_rest(part, state);
  work.resize(part.unknowns());
}

void StepContext::take_temperature() {
  thermal_pressure = path.thermal_pressure();
  free_strain = kacanov::free_strain(part, thermal_pressure);
  body.set_free_strain(free_strain);
  expansion.clear();
  const bool warm =
      std::any_of(thermal_pressure.begin(), thermal_pressure.end(), [](double p) { return p != 0.0; });
  if (!part.node_map.any(warm)) return;
  thermal_pressure.resize(std::max(thermal_pressure.size(), part.element_count()), 0.0);
  expansion.resize(part.unknowns());
  expansion_energy =
      part.node_map.sum_all(reference::expansion_force(part.body(), thermal_pressure, expansion));
  part.node_map.sum(expansion, part.dim());
}

Residuals StepContext::certify(std::span<const double> internal, double energy,
                               std::span<const double> dilatation) const {
  BodyForces forces = body.forces(path);
  forces.internal = internal;
  forces.energy = energy;
  forces.expansion = expansion;
  forces.expansion_energy = expansion_energy;
  forces.regions = &regions;
  const bool counts = !body.linear();
  const auto between = regions.interface_forces(
      state.u, {thermal_pressure, counts ? std::span<const double>(free_strain) : std::span<const double>()},
      dilatation);
  forces.interface = between;
  return kkt_residuals(space, traces, state, forces);
}

Residuals StepContext::certify() const {
  const BodyForces forces = body.forces(path);
  const Vector dilatation = regions.count() > 1 ? corner_dilatation(part, state.u) : Vector();
  Residuals residuals = certify(forces.internal, forces.energy, dilatation);
  if (weights) weights->weight = residuals.scales.weight;
  return residuals;
}

void put_to_rest(const Part& part, ContactState& state) {
  state.u = part.start;
  state.u.resize(part.unknowns(), 0.0);
  state.trace = state.phi = state.lambda = ContactValues(part.contact.size());
  state.bound.assign(part.contact.size(), 0.0);
  state.origin = part.slip_origin;
}

StepOutcome admm_step(StepContext& c, const Penalty& penalty, const Residuals& before, bool first) {
  const bool dual = c.options.contact == SolverOptions::Contact::dual_admm;
  if (!first)
    c.body.freeze_secant(c.state.u);
  else if (c.body.freeze_elastic())  // this load step has been tried before, as a whole
    c.preconditioner.mark_stale();
  c.preconditioner.prepare(penalty, first);
  AdmmOptions options = admm_accuracy(c.options, before, first, c.tuning);
  options.r = penalty;
  options.volume = c.volume;
  if (first) c.body.take_elastic_force(c.state.u);
  c.body.unbalanced(c.path, c.work.residual);
  c.traces.add_force(c.state.lambda, -1.0, c.work.residual);
  const bool touched = touches(c);
  const auto applied = c.body.op().applications();
  const AdmmResult step =
      dual ? dual_admm(c.secant, c.state, c.work, options) : admm(c.secant, c.state, c.work, options);
  StepOutcome outcome;
  outcome.applications = c.body.op().applications() - applied;
  c.preconditioner.watch(step.cg_digits, step.cg_iterations);
  if (!step.solves_converged) c.preconditioner.factorise();
  c.path.prescribe(c.state.u);
  c.state.evaluate(c.traces);
  c.body.evaluate_and_freeze(c.state.u);
  outcome.method = dual ? "dual_admm" : "admm";
  outcome.contact_iterations = step.iterations;
  outcome.cg_iterations = step.cg_iterations;
  outcome.solved = step.solves_converged;
  outcome.arrived = !first && !touched && touches(c);
  outcome.balance = step.balance;
  return outcome;
}

StepOutcome newton_step(StepContext& c, double penalty, bool tangent, const Residuals& before) {
  c.body.freeze_secant(c.state.u);
  const ActiveSet set = decide(c.traces, c.state, c.tuning.decision_share * penalty);
  const double digits = digits_left(c.options, before, c.tuning);
  c.preconditioner.prepare(set, digits);
  // After the setup: the two do not have to fit into memory at once.
  if (tangent) c.body.freeze_tangent(c.state.u);
  const auto applied = c.body.op().applications();
  LinearProblem problem = tangent ? c.tangent : c.secant;
  if (c.part.loose_modes > 0) problem.loose = c.tuning.loose_share * penalty;
  const auto attempt = [&] {
    return active_set_step(problem, c.part, set, c.state, newton_accuracy(c.options, before, c.tuning),
                           c.work);
  };
  ActiveSetStep step = attempt();
  StepOutcome outcome;
  if (!step.met && c.preconditioner.factorise()) {
    outcome.cg_iterations = step.cg_iterations;
    c.preconditioner.prepare(set, digits);
    step = attempt();
  }
  outcome.applications = c.body.op().applications() - applied;
  c.body.forget_tangent();
  outcome.method = tangent ? "newton" : "active_set";
  outcome.contact_iterations = 1;
  outcome.cg_iterations += step.cg_iterations;
  outcome.solved = step.solved;
  outcome.tangent = tangent;
  if (!step.solved) return outcome;
  c.preconditioner.watch(step.cg_digits, step.cg_iterations);
  outcome.length = take_damped(c, step, HeldNodes(c.part, set, c.state));
  c.state.evaluate(c.traces);
  c.body.unbalanced(c.path, c.work.residual);
  recover_multipliers(c.part, c.traces, set, c.work.residual, c.state);
  return outcome;
}

}  // namespace kacanov
