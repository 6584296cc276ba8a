// SPDX-License-Identifier: BSD-3-Clause
// The dual form of ADMM, on multipliers alone (theory: dual-admm).
#include "contact/dual_admm.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/projections.hpp"

namespace kacanov {
namespace {

/// λ₊ and λ₋ at every point, and their last changes.
struct Split {
  ContactValues plus, minus;
  ContactValues minus_step;  ///< change of λ₋, a force density
  double plus_step = 0.0;    ///< max |change of λ₊| / r, which is w − φ in admm()
  Balance balance;

  explicit Split(std::size_t points) : plus(points), minus(points), minus_step(points), balance(points) {}
};

/// Projects `lambda`, and records the changes. Collective.
void project(const Traces& traces, const Penalty& r, const Vector& bound, const ContactValues& lambda,
             Split& split) {
  auto& [plus, minus, minus_step, plus_step, balance] = split;
  plus_step = 0.0;
  const auto points = traces.points();
  // Stores the projection of `whole`; returns the change of λ₊.
  const auto set = [](double& of_plus, double& of_minus, double& step, double projected, double whole) {
    const double moved = projected - of_plus;
    step = (whole - projected) - of_minus;
    of_plus = projected;
    of_minus = whole - projected;
    return moved;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double n = lambda.normal[i];
    const double moved =
        set(plus.normal[i], minus.normal[i], minus_step.normal[i], std::max(n, 0.0), n) / r.normal;
    plus_step = std::max(plus_step, std::abs(moved));
    balance.normal(i, n > 0.0 ? moved : 0.0, n > 0.0 ? 0.0 : minus_step.normal[i]);
    if (points[i].tangents == 0) continue;
    const double* t = &lambda.tangential[2 * i];
    const double length = std::hypot(t[0], t[1]);
    const double scale = length > bound[i] ? bound[i] / length : 1.0;
    double slide[2] = {0.0, 0.0};
    for (std::size_t k = 0; k < static_cast<std::size_t>(points[i].tangents); ++k) {
      const std::size_t at = 2 * i + k;
      slide[k] =
          set(plus.tangential[at], minus.tangential[at], minus_step.tangential[at], scale * t[k], t[k]) /
          r.tangential;
      plus_step = std::max(plus_step, std::abs(slide[k]));
    }
    if (scale == 1.0) {
      balance.tangential(i, std::hypot(slide[0], slide[1]), {});
    } else {
      const double along[2] = {t[0] / length, t[1] / length};
      const double* step = &minus_step.tangential[2 * i];
      const double force = along[0] * step[0] + along[1] * step[1];
      balance.tangential(i, along[0] * slide[1] - along[1] * slide[0], {force * along[0], force * along[1]});
    }
  }
  plus_step = traces.ranks().max_all(plus_step);
}

/// The owned unknowns of u, and their last change.
struct BodyStep {
  std::span<const double> moved, u;
};

/// Criterion by steps (theory: step-stop): relative change of u (by lumped volumes) and φ = ρ + λ₋/r.
/// Collective.
double relative_step(const Traces& traces, const AdmmOptions& options, const Split& split, const Vector& gap,
                     const BodyStep& body) {
  std::array<double, 2> sums{};
  const Penalty& r = options.r;
  const auto points = traces.points();
  for (std::size_t i = 0; i < traces.owned(); ++i) {
    const double step = split.minus_step.normal[i] / r.normal,
                 phi = gap[i] + split.minus.normal[i] / r.normal;
    sums[0] += points[i].mass * step * step;
    sums[1] += points[i].mass * phi * phi;
    for (std::size_t k = 2 * i; k < 2 * i + static_cast<std::size_t>(points[i].tangents); ++k) {
      const double slide = split.minus_step.tangential[k] / r.tangential,
                   slip = split.minus.tangential[k] / r.tangential;
      sums[0] += points[i].mass * slide * slide;
      sums[1] += points[i].mass * slip * slip;
    }
  }
  const std::size_t dim = traces.part().dim();
  for (std::size_t i = 0; i < body.u.size(); ++i) {
    sums[0] += options.volume[i / dim] * body.moved[i] * body.moved[i];
    sums[1] += options.volume[i / dim] * body.u[i] * body.u[i];
  }
  traces.ranks().sum_all(sums);
  return sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}

}  // namespace

AdmmResult dual_admm(const LinearProblem& problem, ContactState& state, CgWork& work,
                     const AdmmOptions& options) {
  const Space& space = *problem.space;
  const Traces& traces = *problem.traces;
  const std::size_t m = traces.size(), n = state.u.size();
  const Penalty& r = options.r;
  const bool stop_by_step = options.step_tolerance > 0.0;
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    const double share = problem.apply(p, q);
    return share + traces.add_penalty(r, p, q);
  };
  AdmmResult result;
  double error = 0.0;
  const auto solve = [&](Vector& x) {
    const CgResult cg =
        conjugate_gradients(space, apply, problem.precondition, x, work, solve_options(options));
    result.cg_iterations += cg.iterations;
    if (cg.iterations > 0 && cg.residual > 0.0)
      result.cg_digits += std::log10(cg.first_residual / cg.residual);
    result.solves_converged = result.solves_converged && cg.converged;
    error = cg.residual;
  };

  // λ₋ = r (φ_n − ρ) and r φ_t (theory: dual-admm).
  Split parts(m);
  ContactValues shift(m), lambda(m), free_trace(m), trace(m);
  for (std::size_t i = 0; i < m; ++i) {
    parts.plus.normal[i] = state.lambda.normal[i];
    parts.minus.normal[i] = r.normal * (state.phi.normal[i] - state.gap[i]);
    shift.normal[i] = r.normal * (state.phi.normal[i] - state.trace.normal[i]);
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) {
      parts.plus.tangential[k] = state.lambda.tangential[k];
      parts.minus.tangential[k] = r.tangential * state.phi.tangential[k];
      shift.tangential[k] = r.tangential * (state.phi.tangential[k] - state.trace.tangential[k]);
    }
  }
  const auto difference = [&](ContactValues& d) {
    for (std::size_t i = 0; i < m; ++i) d.normal[i] = parts.plus.normal[i] - parts.minus.normal[i];
    for (std::size_t k = 0; k < 2 * m; ++k)
      d.tangential[k] = parts.plus.tangential[k] - parts.minus.tangential[k];
  };

  // Warm start: a = B_r⁻¹ (F + r NᵀMρ − CᵀM (λ₊ − λ₋)) with the initial multipliers, solved from u; the
  // paper's a if there are none. v = B_r⁻¹ CᵀM Δ(λ₊ − λ₋) is relative to them, and takes over the remaining
  // residual of a.
  traces.add_force(shift, 1.0, work.residual);
  Vector a = state.u, v(n, 0.0), moved(stop_by_step ? n : 0);
  ContactValues now(m), before(m), change(m);
  difference(before);
  while (!result.converged && result.iterations < options.max_iterations) {
    if (result.iterations == 0) {
      solve(a);
      traces.evaluate(a, free_trace);
      for (std::size_t k = 0; k < state.origin.size(); ++k) free_trace.tangential[k] -= state.origin[k];
      for (double& x : work.residual) x = -x;
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = a[i] - state.u[i];
    } else {
      difference(now);
      for (std::size_t i = 0; i < m; ++i) change.normal[i] = now.normal[i] - before.normal[i];
      for (std::size_t k = 0; k < 2 * m; ++k) change.tangential[k] = now.tangential[k] - before.tangential[k];
      before = now;
      traces.add_force(change, 1.0, work.residual);
      if (stop_by_step) moved = v;
      solve(v);
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] -= v[i];
    }
    traces.evaluate(v, trace);
    // v is in the free space; prescribed components are in a.
    for (std::size_t i = 0; i < m; ++i) {
      lambda.normal[i] =
          parts.plus.normal[i] + r.normal * (free_trace.normal[i] - trace.normal[i] - state.gap[i]);
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
        lambda.tangential[k] =
            parts.plus.tangential[k] + r.tangential * (free_trace.tangential[k] - trace.tangential[k]);
    }
    project(traces, r, state.bound, lambda, parts);
    parts.balance.finish(traces);
    result.trace_residual = parts.plus_step;
    result.force_residual = error + options.contact_weight * traces.force_norm(parts.minus_step);
    ++result.iterations;
    if (stop_by_step) {
      const std::size_t owned = space.part().owned_unknowns();
      Vector u(owned);
      for (std::size_t i = 0; i < owned; ++i) u[i] = a[i] - v[i];
      result.step = relative_step(traces, options, parts, state.gap, {std::span(moved).first(owned), u});
      result.converged = result.step < options.step_tolerance;
    } else {
      result.converged = meets_tolerances(result, options, traces, parts.plus);
    }
    if (!std::isfinite(result.force_residual)) break;
  }

  for (std::size_t i = 0; i < n; ++i) state.u[i] = a[i] - v[i];
  state.evaluate(traces);
  state.lambda = parts.plus;
  for (std::size_t i = 0; i < m; ++i) {
    state.phi.normal[i] = state.gap[i] + parts.minus.normal[i] / r.normal;
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
      state.phi.tangential[k] = parts.minus.tangential[k] / r.tangential;
  }
  result.balance = parts.balance.samples();
  return result;
}

}  // namespace kacanov
