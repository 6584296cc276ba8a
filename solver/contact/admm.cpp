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

/// Steps 2 and 3 at every point. `shift` becomes r(φ₊ − φ) − (λ₊ − λ), what the right side of step 1 changes
/// by; `dual` becomes r(φ − w) + λ₊ − λ, minus which the linear equilibrium is left with.
void update_multipliers(const Traces& traces, ContactState& state, const AdmmOptions& options,
                        ContactValues& shift, ContactValues& dual, double& trace_residual, StepNorm& norm,
                        Balance& balance) {
  const auto points = traces.points();
  const Penalty& r = options.r;
  const double alpha = options.relaxation;
  trace_residual = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool owned = i < traces.owned();
    const auto& point = points[i];
    {
      double& phi = state.phi.normal[i];
      double& lambda = state.lambda.normal[i];
      const double w = state.trace.normal[i];
      const NormalStep next = normal_step(alpha * w + (1.0 - alpha) * phi, lambda, state.gap[i], r.normal);
      shift.normal[i] = r.normal * (next.phi - phi) - (next.lambda - lambda);
      dual.normal[i] = r.normal * (phi - w) + next.lambda - lambda;
      if (owned) norm.add(point.mass, phi, next.phi);
      const bool touches = next.lambda > 0.0;
      balance.normal(i, touches ? w - next.phi : 0.0, touches ? 0.0 : r.normal * (phi - w));
      phi = next.phi;
      lambda = next.lambda;
      trace_residual = std::max(trace_residual, std::abs(w - phi));
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
      balance.tangential(i, std::hypot(w[0], w[1]), {});
    } else {
      const double along[2] = {next.phi[0] / slip, next.phi[1] / slip};
      const double force = r.tangential * (along[0] * (phi[0] - w[0]) + along[1] * (phi[1] - w[1]));
      balance.tangential(i, along[0] * w[1] - along[1] * w[0], {force * along[0], force * along[1]});
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k) {
      shift.tangential[2 * i + k] = r.tangential * (next.phi[k] - phi[k]) - (next.lambda[k] - lambda[k]);
      dual.tangential[2 * i + k] = r.tangential * (phi[k] - w[k]) + next.lambda[k] - lambda[k];
      if (owned) norm.add(point.mass, phi[k], next.phi[k]);
      phi[k] = next.phi[k];
      lambda[k] = next.lambda[k];
      trace_residual = std::max(trace_residual, std::abs(w[k] - phi[k]));
    }
  }
  trace_residual = traces.halo().max_all(trace_residual);
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

  ContactValues shift(traces.size()), dual(traces.size());
  // The penalty's part of the residual, CᵀM r(φ − Cω), in (factor 1) or out (−1).
  const auto add_penalty_residual = [&](double factor) {
    for (std::size_t i = 0; i < traces.size(); ++i) {
      shift.normal[i] = options.r.normal * (state.phi.normal[i] - state.trace.normal[i]);
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
        shift.tangential[k] = options.r.tangential * (state.phi.tangential[k] - state.trace.tangential[k]);
    }
    traces.add_force(shift, factor, work.residual);
  };
  add_penalty_residual(1.0);

  AdmmResult result;
  Balance balance(traces.size());
  Vector before(stop_by_step ? state.omega.size() : 0);
  while (!result.converged && result.iterations < options.max_iterations) {
    if (stop_by_step) before = state.omega;
    const CgResult solve =
        conjugate_gradients(space, apply, problem.precondition, state.omega, work, solve_options(options));
    result.cg_iterations += solve.iterations;
    if (solve.iterations > 0 && solve.residual > 0.0)
      result.cg_digits += std::log10(solve.first_residual / solve.residual);
    result.solves_converged = result.solves_converged && solve.converged;
    state.evaluate(traces);

    StepNorm norm;
    update_multipliers(traces, state, options, shift, dual, result.trace_residual, norm, balance);
    balance.finish(traces);
    result.force_residual = solve.residual + traces.force_norm(dual);
    traces.add_force(shift, 1.0, work.residual);
    ++result.iterations;
    if (stop_by_step) {
      for (std::size_t i = 0; i < space.part().owned_unknowns(); ++i)
        norm.add(options.volume[i / dim], before[i], state.omega[i]);
      std::array<double, 2> sums{norm.change, norm.size};
      traces.halo().sum_all(sums);
      result.step = sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
      result.converged = result.step < options.step_tolerance;
    } else {
      result.converged = meets_tolerances(result, options, traces, state.lambda);
    }
    if (!std::isfinite(result.force_residual)) break;
  }
  add_penalty_residual(-1.0);
  result.balance = balance.samples();
  return result;
}

}  // namespace kacanov
