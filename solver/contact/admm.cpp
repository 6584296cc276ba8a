// SPDX-License-Identifier: BSD-3-Clause
// ADMM on one linearised contact problem, with inexact solves (theory: admm, inexact-solves).
#include "contact/admm.hpp"

#include <algorithm>
#include <cmath>

#include "contact/projections.hpp"

namespace kacanov {
namespace {

/// Σ weight (new − old)² and Σ weight new² for the stop by steps (theory: step-stop).
struct StepNorm {
  double change = 0.0, size = 0.0;
  void add(double weight, double before, double after) {
    change += weight * (after - before) * (after - before);
    size += weight * after * after;
  }
};

/// Results of steps 2 and 3 besides φ and λ.
struct PointwiseSteps {
  ContactValues shift;  ///< r(φ₊ − φ) − (λ₊ − λ): the change of the right-hand side of step 1
  ContactValues dual;  ///< r(φ − w) + λ₊ − λ: minus the remaining residual of the linear equilibrium
  Balance balance;
  StepNorm norm;                ///< of φ
  double trace_residual = 0.0;  ///< max |w − φ₊|

  explicit PointwiseSteps(std::size_t points) : shift(points), dual(points), balance(points) {}
};

/// Steps 2 and 3 at every point. Collective.
void update_multipliers(const Traces& traces, const AdmmOptions& options, ContactState& state,
                        PointwiseSteps& steps) {
  const auto points = traces.points();
  const Penalty& r = options.r;
  const double alpha = options.relaxation;
  steps.trace_residual = 0.0;
  steps.norm = {};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool owned = i < traces.owned();
    const auto& point = points[i];
    {
      double& phi = state.phi.normal[i];
      double& lambda = state.lambda.normal[i];
      const double w = state.trace.normal[i];
      const NormalStep next = normal_step(alpha * w + (1.0 - alpha) * phi, lambda, state.gap[i], r.normal);
      steps.shift.normal[i] = r.normal * (next.phi - phi) - (next.lambda - lambda);
      steps.dual.normal[i] = r.normal * (phi - w) + next.lambda - lambda;
      if (owned) steps.norm.add(point.mass, phi, next.phi);
      const bool touches = next.lambda > 0.0;
      steps.balance.normal(i, touches ? w - next.phi : 0.0, touches ? 0.0 : r.normal * (phi - w));
      phi = next.phi;
      lambda = next.lambda;
      steps.trace_residual = std::max(steps.trace_residual, std::abs(w - phi));
    }
    if (point.tangents == 0) continue;
    double* phi = &state.phi.tangential[2 * i];
    double* lambda = &state.lambda.tangential[2 * i];
    const double* w = &state.trace.tangential[2 * i];
    const double relaxed[2] = {alpha * w[0] + (1.0 - alpha) * phi[0], alpha * w[1] + (1.0 - alpha) * phi[1]};
    const bool sticks = options.sticking && point.coulomb > 0.0 && state.lambda.normal[i] > 0.0;
    const double bound = sticks ? HUGE_VAL : state.bound[i];
    const TangentialStep next = tangential_step(relaxed, lambda, bound, r.tangential);
    const double slip = std::hypot(next.phi[0], next.phi[1]);
    if (slip == 0.0) {
      steps.balance.tangential(i, std::hypot(w[0], w[1]), {});
    } else {
      const double along[2] = {next.phi[0] / slip, next.phi[1] / slip};
      const double force = r.tangential * (along[0] * (phi[0] - w[0]) + along[1] * (phi[1] - w[1]));
      steps.balance.tangential(i, along[0] * w[1] - along[1] * w[0], {force * along[0], force * along[1]});
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k) {
      steps.shift.tangential[2 * i + k] =
          r.tangential * (next.phi[k] - phi[k]) - (next.lambda[k] - lambda[k]);
      steps.dual.tangential[2 * i + k] = r.tangential * (phi[k] - w[k]) + next.lambda[k] - lambda[k];
      if (owned) steps.norm.add(point.mass, phi[k], next.phi[k]);
      phi[k] = next.phi[k];
      lambda[k] = next.lambda[k];
      steps.trace_residual = std::max(steps.trace_residual, std::abs(w[k] - phi[k]));
    }
  }
  steps.trace_residual = traces.ranks().max_all(steps.trace_residual);
}

}  // namespace

AdmmResult admm(const LinearProblem& problem, ContactState& state, CgWork& work, const AdmmOptions& options) {
  const Space& space = *problem.space;
  const Traces& traces = *problem.traces;
  const std::size_t dim = space.part().dim();
  const bool stop_by_step = options.step_tolerance > 0.0;
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    const double share = problem.apply(p, q);
    return share + traces.add_penalty(options.r, p, q);
  };

  PointwiseSteps steps(traces.size());
  // Adds (factor 1) or removes (−1) the penalty's part of the residual, CᵀM r(φ − Cu).
  const auto add_penalty_residual = [&](double factor) {
    for (std::size_t i = 0; i < traces.size(); ++i) {
      steps.shift.normal[i] = options.r.normal * (state.phi.normal[i] - state.trace.normal[i]);
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
        steps.shift.tangential[k] =
            options.r.tangential * (state.phi.tangential[k] - state.trace.tangential[k]);
    }
    traces.add_force(steps.shift, factor, work.residual);
  };
  add_penalty_residual(1.0);

  AdmmResult result;
  Vector before(stop_by_step ? state.u.size() : 0);
  while (!result.converged && result.iterations < options.max_iterations) {
    if (stop_by_step) before = state.u;
    const CgResult solve =
        conjugate_gradients(space, apply, problem.precondition, state.u, work, solve_options(options));
    result.cg_iterations += solve.iterations;
    if (solve.iterations > 0 && solve.residual > 0.0)
      result.cg_digits += std::log10(solve.first_residual / solve.residual);
    result.solves_converged = result.solves_converged && solve.converged;
    state.evaluate(traces);

    update_multipliers(traces, options, state, steps);
    steps.balance.finish(traces);
    result.trace_residual = steps.trace_residual;
    result.force_residual = solve.residual + options.contact_weight * traces.force_norm(steps.dual);
    traces.add_force(steps.shift, 1.0, work.residual);
    ++result.iterations;
    if (stop_by_step) {
      for (std::size_t i = 0; i < space.part().owned_unknowns(); ++i)
        steps.norm.add(options.volume[i / dim], before[i], state.u[i]);
      std::array<double, 2> sums{steps.norm.change, steps.norm.size};
      traces.ranks().sum_all(sums);
      result.step = sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
      result.converged = result.step < options.step_tolerance;
    } else {
      result.converged = meets_tolerances(result, options, traces, state.lambda);
    }
    if (!std::isfinite(result.force_residual)) break;
  }
  add_penalty_residual(-1.0);
  result.balance = steps.balance.samples();
  if (options.collect_evidence) {
    result.evidence = {state.trace, state.phi, state.lambda, state.lambda};
    ContactValues& answered = result.evidence.answered;
    for (std::size_t i = 0; i < traces.size(); ++i) answered.normal[i] -= steps.dual.normal[i];
    for (std::size_t k = 0; k < 2 * traces.size(); ++k) answered.tangential[k] -= steps.dual.tangential[k];
  }
  return result;
}

}  // namespace kacanov
