// SPDX-License-Identifier: BSD-3-Clause
// Accuracy of each step's solve, from the residuals at its start.
#include "nonlinear/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

AdmmOptions admm_accuracy(const SolverOptions& options, const Residuals& before, bool first,
                          const Tuning& tuning) {
  const bool by_step = options.stop == SolverOptions::Stop::paper;
  const bool as_printed = by_step || options.penalty == SolverOptions::Penalty::paper;
  const Scales& scales = before.scales;
  AdmmOptions out;
  out.relaxation = options.relaxation.value_or(as_printed ? 1.0 : 1.7);
  out.max_iterations = options.max_contact;
  out.max_cg = options.max_cg;
  out.collect_evidence = follows_rule(options.penalty);
  out.contact_weight = scales.contact_weight();
  if (by_step) {
    out.step_tolerance = options.tolerance;
    out.force_tolerance = 1e-2 * options.tolerance * scales.force;
    return out;
  }
  // At rest, or after a rigid placement, there is no displacement scale yet.
  const bool scaled = !first && scales.displacement > 0.0;
  const double worst = scaled ? std::min(before.certificate.worst(), 1.0) : 1.0;
  const double share = scaled ? gap_share(before.certificate) : 1.0;
  const double reach = std::max(0.5 * options.tolerance, tuning.inner_reduction * worst) * share;
  out.force_tolerance = reach * scales.force;
  // Without a displacement scale any trace is acceptable: the first step stops by its forces.
  out.trace_tolerance = scaled ? reach * scales.trace : HUGE_VAL;
  out.force_reduction = scales.force > 0.0 ? 0.0 : tuning.inner_reduction;
  const bool balanced = options.penalty == SolverOptions::Penalty::automatic;
  // A first penalty of the user's may be far off, so that the first step must not wait for it.
  if (adapts(options.penalty) && (!first || !balanced || options.r > 0.0))
    out.max_iterations = std::min(tuning.balancing_iterations, options.max_contact);
  const bool newton_follows = options.contact == SolverOptions::Contact::automatic ||
                              options.contact == SolverOptions::Contact::active_set;
  if (first && newton_follows) {
    out.sticking = true;
    out.max_iterations = std::min(tuning.opening_iterations, options.max_contact);
  }
  return out;
}

namespace {

/// Returns the target ‖r‖ of a Newton solve that may be the last.
double last_residual(const SolverOptions& options, const Residuals& before, const Tuning& tuning) {
  return tuning.last_share * options.tolerance * gap_share(before.certificate) * before.scales.force;
}

/// Returns the options that all Newton solves share.
CgOptions step_accuracy(const SolverOptions& options, const Tuning& tuning) {
  CgOptions out;
  out.relative = tuning.solve_reduction;
  out.max_iterations = options.max_cg;
  out.asked = tuning.left_out_asked;
  out.share = tuning.left_out_share;
  out.worth = tuning.left_out_worth;
  return out;
}

}  // namespace

CgOptions newton_accuracy(const SolverOptions& options, const Residuals& before, const Tuning& tuning) {
  const double worst = before.certificate.worst();
  CgOptions out = step_accuracy(options, tuning);
  out.absolute = last_residual(options, before, tuning);
  out.reach = tuning.last_reach;
  // The first residual is inflated: points moved onto the obstacle strain adjacent elements.
  out.most = std::min(worst, 1.0) * before.scales.force;
  return out;
}

double digits_left(const SolverOptions& options, const Residuals& before, const Tuning& tuning) {
  const double left = before.certificate.worst() / (tuning.last_share * options.tolerance);
  return left > 1.0 ? std::log10(left) : 0.0;
}

AugmentedAccuracy augmented_accuracy(const SolverOptions& options, const Residuals& before,
                                     const Tuning& tuning) {
  AugmentedAccuracy out{last_residual(options, before, tuning), step_accuracy(options, tuning)};
  out.solve.absolute = 0.5 * out.force;
  return out;
}

double gap_share(const Certificate& c) {
  const double others =
      std::max({c.equilibrium, c.penetration, c.tension, c.complementarity, c.friction_cone});
  const double sums = std::max(c.duality_gap, c.force_balance);
  return others > 0.0 && std::isfinite(sums) ? std::clamp(others / std::max(others, sums), 1e-4, 1.0) : 1.0;
}

}  // namespace kacanov
