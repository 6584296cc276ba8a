// SPDX-License-Identifier: BSD-3-Clause
// One step of the outer loop: ADMM with the secant, semismooth Newton, or the method of multipliers.
#include "nonlinear/step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <kacanov/part.hpp>
#include <kacanov/reference.hpp>
#include "amg/make_preconditioner.hpp"
#include "contact/active_constraints.hpp"
#include "contact/active_set_step.hpp"
#include "contact/augmented.hpp"
#include "contact/dual_admm.hpp"
#include "contact/linearisation_error.hpp"
#include "linear/reference_response.hpp"
#include "nonlinear/accuracy.hpp"
#include "nonlinear/body_response.hpp"
#include "nonlinear/line_search.hpp"
#include "nonlinear/loop_control.hpp"

namespace kacanov {
namespace {

/// u += t δ with t limited by damping, or extended by the line search. Leaves R(u) and the frozen secant at
/// the new u.
double take_damped(StepContext& c, const ActiveSetStep& step, const HeldNodes& nodes) {
  const Vector& delta = step.delta;
  // The solve is finished, so its work vectors are free.
  Vector &from = c.work.direction, &force = c.work.image, &u = c.state.u;
  from = u;
  force.assign(c.body.internal().begin(), c.body.internal().end());
  const auto go_to = [&](double t) {
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = from[i] + t * delta[i];
    c.path.prescribe(u);  // removes the rounding that the solve's iterations added along held directions
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
  forces.tolerance = options.tolerance;
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
  outcome.evidence = step.evidence;
  return outcome;
}

StepOutcome newton_step(StepContext& c, double penalty, bool tangent, const Residuals& before) {
  c.body.freeze_secant(c.state.u);
  const ActiveSet set = decide(c.traces, c.state, c.tuning.decision_share * penalty);
  const double digits = digits_left(c.options, before, c.tuning);
  c.preconditioner.prepare(set, digits);
  // After the setup, so that both need not fit into memory at the same time.
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

namespace {

/// Semismooth Newton steps with a line search on the augmented Lagrangian.
class Descent {
 public:
  Descent(StepContext& c, double r, double contact_weight)
      : c_(c), contact_(c.traces, c.state, r), contact_weight_(contact_weight), delta_(c.part.unknowns()) {}

  /// Sets work.residual to F − R(u) − CᵀMp and returns its residual_norm; `moved`: the same norm of CᵀM (p −
  /// λ).
  double unbalanced(double& moved) {
    ContactValues p = contact_.multipliers(c_.state.trace);
    c_.body.unbalanced(c_.path, c_.work.residual);
    c_.traces.add_force(p, -1.0, c_.work.residual);
    c_.space.project(c_.work.residual);
    for (std::size_t i = 0; i < p.normal.size(); ++i) p.normal[i] -= c_.state.lambda.normal[i];
    for (std::size_t i = 0; i < p.tangential.size(); ++i) p.tangential[i] -= c_.state.lambda.tangential[i];
    moved = contact_weight_ * c_.traces.force_norm(p);
    return c_.space.residual_norm(c_.work.residual);
  }

  /// Solves from the current residual; returns whether that gave a descent direction.
  bool step(bool tangent, CgOptions options, StepOutcome& outcome) {
    const ActiveSet set = contact_.derivative(c_.state.trace);
    c_.preconditioner.prepare(set, contact_.penalty(), loose());
    if (tangent) c_.body.freeze_tangent(c_.state.u);
    const LinearProblem& problem = tangent ? c_.tangent : c_.secant;
    std::fill(delta_.begin(), delta_.end(), 0.0);
    const Vector pull = c_.work.residual;
    const auto apply = [&](std::span<const double> p, std::span<double> q) {
      const double share = problem.apply(p, q);
      return share + contact_.add_stiffness(set, p, q) + hold_loosely(p, q);
    };
    if (problem.unbalanced)
      options.left_out = [&] {
        return left_out(problem, c_.space, c_.state, delta_, c_.work,
                        [&](const ContactValues& trace, Vector& f) {
                          c_.traces.add_force(contact_.multipliers(trace), -1.0, f);
                        });
      };
    CgResult solve = conjugate_gradients(c_.space, apply, problem.precondition, delta_, c_.work, options);
    if (!solve.converged && c_.preconditioner.factorise()) {
      outcome.cg_iterations += solve.iterations;
      c_.preconditioner.prepare(set, contact_.penalty(), loose());
      std::fill(delta_.begin(), delta_.end(), 0.0);
      c_.work.residual = pull;
      solve = conjugate_gradients(c_.space, apply, problem.precondition, delta_, c_.work, options);
    }
    c_.body.forget_tangent();
    outcome.cg_iterations += solve.iterations;
    if (solve.iterations > 0 && solve.residual > 0.0)
      c_.preconditioner.watch(std::log10(solve.first_residual / solve.residual), solve.iterations);
    const double slope = -c_.space.dot(pull, delta_);
    if (!(slope < 0.0)) return false;
    follow(slope);
    return true;
  }
  double length() const noexcept { return t_; }
  ContactValues multipliers() const { return contact_.multipliers(c_.state.trace); }

 private:
  double loose() const { return c_.part.loose_modes > 0 ? c_.tuning.loose_share * contact_.penalty() : 0.0; }
  /// Keeps the operator definite if contact alone holds rigid-body modes: slipping points have no stiffness
  /// along their slip.
  double hold_loosely(std::span<const double> p, std::span<double> q) const {
    const double r = loose();
    return r > 0.0 ? c_.traces.add_penalty({r, r}, p, q) : 0.0;
  }

  void follow(double slope) {
    Vector &from = c_.work.direction, &u = c_.state.u;
    from = u;
    Vector& rest = c_.work.residual;
    t_ = find_step(slope,
                   [&](double t) {
                     for (std::size_t i = 0; i < u.size(); ++i) u[i] = from[i] + t * delta_[i];
                     c_.path.prescribe(u);
                     c_.body.evaluate_and_freeze(u);
                     c_.state.evaluate(c_.traces);
                     c_.body.unbalanced(c_.path, rest);
                     c_.traces.add_force(contact_.multipliers(c_.state.trace), -1.0, rest);
                     return -c_.space.dot(delta_, rest);
                   },
                   {.longest = c_.body.linear() ? 1.0 : c_.tuning.longest_step});
  }

  StepContext& c_;
  AugmentedContact contact_;
  double contact_weight_;
  Vector delta_;
  double t_ = 1.0;
};

}  // namespace

StepOutcome augmented_step(StepContext& c, AugmentedControl& control, const Residuals& before) {
  StepOutcome outcome;
  outcome.method = "augmented";
  const auto applied = c.body.op().applications();
  const AugmentedAccuracy accuracy = augmented_accuracy(c.options, before, c.tuning);
  control.advance(c.traces, c.state);
  Descent descent(c, control.penalty(), before.scales.contact_weight());
  const bool may_tangent = !c.body.linear() && c.options.outer != SolverOptions::Outer::kacanov;
  bool tangent = may_tangent;
  for (;;) {
    double moved = 0.0;
    const double force = descent.unbalanced(moved);
    if (force <= std::max(accuracy.force, c.tuning.augmented_balance * moved) &&
        outcome.contact_iterations > 0)
      break;
    if (outcome.contact_iterations == c.tuning.augmented_iterations || !std::isfinite(force)) break;
    ++outcome.contact_iterations;
    if (!descent.step(tangent, accuracy.solve, outcome)) {
      outcome.solved = false;
      break;
    }
    tangent = may_tangent && descent.length() > c.tuning.short_step;
  }
  control.learn(outcome.contact_iterations);
  outcome.applications = c.body.op().applications() - applied;
  c.state.lambda = descent.multipliers();
  for (std::size_t i = 0; i < c.state.gap.size(); ++i)
    c.state.phi.normal[i] = std::min(c.state.trace.normal[i], c.state.gap[i]);
  c.state.phi.tangential = c.state.trace.tangential;
  return outcome;
}

}  // namespace kacanov
