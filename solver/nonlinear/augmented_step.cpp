// SPDX-License-Identifier: BSD-3-Clause
// A step of the method of multipliers: the augmented Lagrangian minimised over the displacement.
#include "nonlinear/augmented_step.hpp"

#include <algorithm>
#include <cmath>

#include "contact/augmented.hpp"
#include "contact/left_out.hpp"
#include "nonlinear/accuracy.hpp"
#include "nonlinear/line_search.hpp"

namespace kacanov {
namespace {

/// One semismooth Newton step with a line search on the way to a minimiser.
class Descent {
 public:
  Descent(StepContext& c, double r, double contact_weight)
      : c_(c), contact_(c.traces, c.state, r), contact_weight_(contact_weight), delta_(c.part.unknowns()) {}

  /// Puts F − R(u) − CᵀMp into the residual. Returns its residual_norm; `moved`: that of CᵀM (p − λ),
  /// likewise.
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

  /// From the residual there is. Whether the solve gave a direction to go.
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
  /// Where contact alone holds motions, points that slip leave nothing along their slip.
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
