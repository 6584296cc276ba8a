// SPDX-License-Identifier: BSD-3-Clause
// ADMM (Uzawa block relaxation; theory: admm) on one linearised contact problem, with inexact
// solves.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include <kacanov/model.hpp>
#include "contact/balance.hpp"
#include "contact/contact_state.hpp"
#include "multigrid/cg.hpp"

namespace kacanov {

/// A linearised problem: B, frozen, and its preconditioner for B + r CᵀMC.
struct LinearProblem {
  const Space* space = nullptr;
  const Traces* traces = nullptr;
  /// y = B x, consistent; returns this rank's share of xᵀ y.
  std::function<double(std::span<const double>, std::span<double>)> apply;
  std::function<void(std::span<const double>, std::span<double>)> precondition;  ///< z ≈ (B + r CᵀMC)⁻¹ r
  /// Penalty on slip that preconditions Newton steps with sliding friction, where contact alone holds
  /// motions.
  double loose = 0.0;
  /// f = F − R(u) of the state that the problem is linearised at, for Newton steps.
  std::function<void(std::span<double>)> pull = {};
  /// f = F − R(u) anywhere, of a body whose response is not linear. Collective.
  std::function<void(std::span<const double>, std::span<double>)> unbalanced = {};
};

struct AdmmOptions {
  Penalty r;
  double relaxation = 1.0;       ///< α: Nu is replaced by α Nu + (1 − α) φ in steps 2 and 3
  double force_tolerance = 0.0;  ///< absolute, on the residual of the linear equilibrium
  double force_reduction = 0.0;  ///< or relative to the contact force: where nothing else sets a scale
  double contact_weight = 1.0;   ///< of contact forces beside the residual's (Scales::contact_weight)
  double trace_tolerance = 0.0;  ///< absolute, on max |Cu − φ|
  int max_iterations = 10000;
  int max_cg = SolverOptions{}.max_cg;  ///< CG iterations of one solve
  /// Points under pressure that Coulomb's friction acts on stick, whatever their bound.
  bool sticking = false;
  /// With ε > 0 the stop is by steps (theory: step-stop), and the solves are as exact as the tolerances
  /// above.
  double step_tolerance = 0.0;
  std::span<const double> volume;  ///< lumped volume of each node for the L² norm of that stop
};

struct AdmmResult {
  int iterations = 0;
  std::int64_t cg_iterations = 0;
  double cg_digits = 0.0;              ///< decimal digits gained by all solves together
  double force_residual = 0.0;         ///< ‖linear equilibrium with the new multipliers‖
  double trace_residual = 0.0;         ///< max |Cu − φ|
  std::vector<BalanceSample> balance;  ///< of every iteration
  double step = 0.0;                   ///< ‖change‖ / ‖state‖ of that stop
  bool converged = false;
  bool solves_converged = true;
};

/// How exact each solve is: the first residual is what the last projection changed, a tenth of it is exact
/// enough (inexact ADMM) where the loop is judged by residuals and not by its steps.
inline CgOptions solve_options(const AdmmOptions& options) {
  return {0.2 * options.force_tolerance, options.step_tolerance > 0.0 ? 1e-12 : 0.1, options.max_cg};
}

/// Whether the residuals of `result` meet the tolerances; `lambda` as it is now.
inline bool meets_tolerances(const AdmmResult& result, const AdmmOptions& options, const Traces& traces,
                             const ContactValues& lambda) {
  const double enough = options.force_reduction > 0.0
                            ? options.force_reduction * options.contact_weight * traces.force_norm(lambda)
                            : 0.0;
  return result.force_residual <= std::max(options.force_tolerance, enough) &&
         result.trace_residual <= options.trace_tolerance;
}

/// Iterates until both tolerances (or the stop by steps) are met. `work.residual` holds F − R(u) − CᵀMλ for
/// the linearisation at state.u on entry, the same with the frozen B on exit (up to held components).
AdmmResult admm(const LinearProblem& problem, ContactState& state, CgWork& work, const AdmmOptions& options);

}  // namespace kacanov
