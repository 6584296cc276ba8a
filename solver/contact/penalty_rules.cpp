// SPDX-License-Identifier: BSD-3-Clause
// Published rules for one penalty of ADMM, as rivals of the balance (theory: penalty-rules).
#include "contact/penalty_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kacanov {
namespace {

/// Returns a − b.
ContactValues difference(const ContactValues& a, const ContactValues& b) {
  ContactValues out = a;
  for (std::size_t i = 0; i < out.normal.size(); ++i) out.normal[i] -= b.normal[i];
  for (std::size_t k = 0; k < out.tangential.size(); ++k) out.tangential[k] -= b.tangential[k];
  return out;
}

/// Returns this rank's share of aᵀ M b over both traces.
double share(const Traces& traces, const ContactValues& a, const ContactValues& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < traces.owned(); ++i)
    sum += traces.points()[i].mass * (a.normal[i] * b.normal[i] + a.tangential[2 * i] * b.tangential[2 * i] +
                                      a.tangential[2 * i + 1] * b.tangential[2 * i + 1]);
  return sum;
}

/// Norms of the residuals w − φ and λ − (λ + r(w − φ)), and of the traces and forces for relative ones.
struct Norms {
  double primal = 0.0, dual = 0.0, trace = 0.0, force = 0.0;

  Norms(const PenaltyEvidence& now, const Traces& traces) {
    const ContactValues open = difference(now.trace, now.phi), left = difference(now.lambda, now.answered);
    std::array<double, 5> sums{share(traces, open, open), share(traces, left, left),
                               share(traces, now.trace, now.trace), share(traces, now.phi, now.phi),
                               share(traces, now.lambda, now.lambda)};
    traces.ranks().sum_all(sums);
    primal = std::sqrt(sums[0]);
    dual = std::sqrt(sums[1]);
    trace = std::sqrt(std::max(sums[2], sums[3]));
    force = std::sqrt(sums[4]);
  }
  /// Returns primal over dual, each relative to its size; 1 without data.
  double relative() const {
    const double ratio = (primal * force) / (dual * trace);
    return std::isfinite(ratio) && ratio > 0.0 ? ratio : 1.0;
  }
};

/// Residual balancing: twice the penalty if the primal residual is more than ten times the dual one, half of
/// it in the opposite case [HYW].
double balance_residuals(double r, double primal, double dual) {
  constexpr double most = 10.0, factor = 2.0;
  if (primal > most * dual) return r * factor;
  return dual > most * primal ? r / factor : r;
}

/// OSQP: r times the root of the ratio of the relative residuals, if that is more than a factor of 5 [O].
double osqp(double r, double relative) {
  constexpr double least_change = 5.0;
  const double factor = std::sqrt(relative);
  return factor > least_change || factor < 1.0 / least_change ? r * factor : r;
}

/// Returns the hybrid Barzilai–Borwein step size from ‖f‖², f·w and ‖w‖², if f and w correlate.
std::optional<double> curvature(double ff, double fw, double ww) {
  constexpr double least_correlation = 0.2;
  if (!(fw > least_correlation * std::sqrt(ff * ww))) return std::nullopt;
  const double steepest = ff / fw, least_gradient = fw / ww;
  return 2.0 * least_gradient > steepest ? least_gradient : steepest - 0.5 * least_gradient;
}

/// Adaptive ADMM: spectral estimates of the curvature of both halves since the step before, each used where
/// its changes correlate [XFG].
double spectral(double r, const PenaltyEvidence& now, const PenaltyEvidence& before, const Traces& traces) {
  // The body: w moves against the force that it answers. The contact: φ moves along λ.
  const ContactValues force = difference(before.answered, now.answered),
                      moved = difference(now.trace, before.trace),
                      pressed = difference(now.lambda, before.lambda),
                      opened = difference(now.phi, before.phi);
  std::array<double, 6> sums{share(traces, force, force),    share(traces, moved, force),
                             share(traces, moved, moved),    share(traces, pressed, pressed),
                             share(traces, opened, pressed), share(traces, opened, opened)};
  traces.ranks().sum_all(sums);
  const auto body = curvature(sums[0], sums[1], sums[2]), contact = curvature(sums[3], sums[4], sums[5]);
  if (body && contact) return std::sqrt(*body * *contact);
  return body ? *body : contact ? *contact : r;
}

}  // namespace

double next_penalty(SolverOptions::Penalty rule, double r, const PenaltyEvidence& now,
                    const PenaltyEvidence* before, const Traces& traces) {
  double next = r;
  if (rule == SolverOptions::Penalty::spectral) {
    if (before) next = spectral(r, now, *before, traces);
  } else {
    const Norms norms(now, traces);
    if (rule == SolverOptions::Penalty::residuals) next = balance_residuals(r, norms.primal, norms.dual);
    if (rule == SolverOptions::Penalty::relative_residuals)
      next = balance_residuals(r, norms.relative(), 1.0);
    if (rule == SolverOptions::Penalty::osqp) next = osqp(r, norms.relative());
  }
  return std::isfinite(next) && next > 0.0 ? next : r;
}

}  // namespace kacanov
