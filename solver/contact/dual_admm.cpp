// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 2 of the paper: the dual form of ADMM, on multipliers alone.
#include "contact/dual_admm.hpp"

#include <algorithm>
#include <cmath>

#include "contact/balance.hpp"
#include "contact/projections.hpp"

namespace kacanov {
namespace {

/// λ₊ and λ₋ at every point.
struct Split {
  ContactValues plus, minus;
  explicit Split(std::size_t points) : plus(points), minus(points) {}
};

/// Projects `lambda` and notes how far both parts moved: λ₋ by `minus_step` (a force density), λ₊ at most by
/// `plus_step`.
void split(const Traces& traces, const ContactValues& lambda, const Vector& bound, const Penalty& r,
           Split& parts, ContactValues& minus_step, double& plus_step, Balance& balance) {
  plus_step = 0.0;
  const auto points = traces.points();
  const auto set = [&](double& plus, double& minus, double& step, double projected, double whole) {
    plus_step = std::max(plus_step, std::abs(projected - plus));
    step = (whole - projected) - minus;
    plus = projected;
    minus = whole - projected;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double n = lambda.normal[i];
    const double before = parts.plus.normal[i];
    set(parts.plus.normal[i], parts.minus.normal[i], minus_step.normal[i], std::max(n, 0.0), n);
    balance.normal(i, n > 0.0 ? (n - before) / r.normal : 0.0, n > 0.0 ? 0.0 : minus_step.normal[i]);
    if (points[i].tangents == 0) continue;
    const double* t = &lambda.tangential[2 * i];
    const double length = std::hypot(t[0], t[1]);
    const double scale = length > bound[i] ? bound[i] / length : 1.0;
    const double held[2] = {parts.plus.tangential[2 * i], parts.plus.tangential[2 * i + 1]};
    for (std::size_t k = 2 * i; k < 2 * i + static_cast<std::size_t>(points[i].tangents); ++k)
      set(parts.plus.tangential[k], parts.minus.tangential[k], minus_step.tangential[k],
          scale * lambda.tangential[k], lambda.tangential[k]);
    const double change[2] = {parts.plus.tangential[2 * i] - held[0],
                              parts.plus.tangential[2 * i + 1] - held[1]};
    if (scale == 1.0) {
      balance.tangential(i, std::hypot(change[0], change[1]) / r.tangential, {});
    } else {
      const double along[2] = {t[0] / length, t[1] / length};
      const double* step = &minus_step.tangential[2 * i];
      const double force = along[0] * step[0] + along[1] * step[1];
      balance.tangential(i, (along[0] * change[1] - along[1] * change[0]) / r.tangential,
                         {force * along[0], force * along[1]});
    }
  }
  plus_step = traces.halo().max_all(plus_step);
}

}  // namespace

AdmmResult dual_admm(const LinearProblem& problem, ContactState& state, CgWork& work,
                     const AdmmOptions& options) {
  const Space& space = *problem.space;
  const Traces& traces = *problem.traces;
  const auto points = traces.points();
  const std::size_t m = points.size(), n = state.omega.size();
  const Penalty& r = options.r;
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    problem.apply(p, q);
    traces.add_penalty(r, p, q);
  };
  AdmmResult result;
  Balance balance(m);
  const auto solve = [&](Vector& x, double relative) {
    const CgResult cg = conjugate_gradients(space, apply, problem.precondition, x, work,
                                            {0.05 * options.force_tolerance, relative, 2000});
    result.cg_iterations += cg.iterations;
    if (cg.iterations > 0 && cg.residual > 0.0)
      result.cg_digits += std::log10(cg.first_residual / cg.residual);
    result.solves_converged = result.solves_converged && cg.converged;
    return cg.residual;
  };

  // λ₋ = r (ρ − φ_n) and −r φ_f, by (22).
  Split parts(m);
  ContactValues shift(m), step(m), lambda(m), free_trace(m), trace(m);
  for (std::size_t i = 0; i < m; ++i) {
    parts.plus.normal[i] = state.lambda.normal[i];
    parts.minus.normal[i] = r.normal * (state.phi.normal[i] - points[i].gap);
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) {
      parts.plus.tangential[k] = state.lambda.tangential[k];
      parts.minus.tangential[k] = r.tangential * state.phi.tangential[k];
    }
  }

  // a, from ω: the residual with no multipliers, and r NᵀM (ρ − Nω) − r TᵀMTω from the penalty.
  traces.add_force(state.lambda, 1.0, work.residual);
  for (std::size_t i = 0; i < m; ++i) {
    shift.normal[i] = r.normal * (points[i].gap - state.trace.normal[i]);
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
      shift.tangential[k] = -r.tangential * state.trace.tangential[k];
  }
  traces.add_force(shift, 1.0, work.residual);
  Vector a = state.omega;
  double error = solve(a, 1e-10);
  traces.evaluate(a, free_trace);

  // v = B_r⁻¹ CᵀM (λ₊ − λ₋), from one iteration to the next by its change.
  Vector v(n, 0.0);
  const auto difference = [&](ContactValues& d) {
    for (std::size_t i = 0; i < m; ++i) d.normal[i] = parts.plus.normal[i] - parts.minus.normal[i];
    for (std::size_t k = 0; k < 2 * m; ++k)
      d.tangential[k] = parts.plus.tangential[k] - parts.minus.tangential[k];
  };
  ContactValues now(m), before(m), change(m);
  std::fill(work.residual.begin(), work.residual.end(), 0.0);
  while (!result.converged && result.iterations < options.max_iterations) {
    difference(now);
    for (std::size_t i = 0; i < m; ++i) change.normal[i] = now.normal[i] - before.normal[i];
    for (std::size_t k = 0; k < 2 * m; ++k) change.tangential[k] = now.tangential[k] - before.tangential[k];
    before = now;
    traces.add_force(change, 1.0, work.residual);
    error = solve(v, options.step_tolerance > 0.0 ? 1e-12 : 1e-3);
    traces.evaluate(v, trace);
    // v lives in the free space; prescribed components are in a.
    for (std::size_t i = 0; i < m; ++i) {
      lambda.normal[i] =
          parts.plus.normal[i] + r.normal * (free_trace.normal[i] - trace.normal[i] - points[i].gap);
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
        lambda.tangential[k] =
            parts.plus.tangential[k] + r.tangential * (free_trace.tangential[k] - trace.tangential[k]);
    }
    double plus_step = 0.0;
    split(traces, lambda, state.bound, r, parts, step, plus_step, balance);
    balance.finish(traces, options.trace_tolerance, options.force_tolerance);
    result.trace_residual = plus_step / std::min(r.normal, r.tangential);
    result.force_residual = error + traces.force_norm(step);
    ++result.iterations;
    const double enough =
        options.force_reduction > 0.0 ? options.force_reduction * traces.force_norm(parts.plus) : 0.0;
    result.converged = result.force_residual <= std::max(options.force_tolerance, enough) &&
                       result.trace_residual <= options.trace_tolerance;
    if (!std::isfinite(result.force_residual)) break;
  }

  for (std::size_t i = 0; i < n; ++i) state.omega[i] = a[i] - v[i];
  traces.evaluate(state.omega, state.trace);
  state.lambda = parts.plus;
  for (std::size_t i = 0; i < m; ++i) {
    state.phi.normal[i] = points[i].gap + parts.minus.normal[i] / r.normal;
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
      state.phi.tangential[k] = parts.minus.tangential[k] / r.tangential;
  }
  result.balance = balance.mean();
  return result;
}

}  // namespace kacanov
