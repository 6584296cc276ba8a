// SPDX-License-Identifier: BSD-3-Clause
// ADMM for contact (paper, Algorithm 1), and the rule that balances its residuals.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include <kacanov/model.hpp>
#include "contact/contact_state.hpp"
#include "contact/traces.hpp"
#include "multigrid/cg.hpp"

namespace kacanov {

/// Of one iteration, for N and T: the largest displacement open at A, and the norm of the force that moved at
/// I.
struct BalanceSample {
  std::array<double, 2> held{}, moved{};
};

/// With A the held rows (touching, sticking, and across its slip a slipping point in 3D) and I the free ones,
/// an error at A decays by 1/(1 + r λ(K_AA)) an iteration and one at I by r λ(K_I|A)/(1 + r λ(K_I|A)): a
/// larger r speeds up the one and slows down the other. Both show, as a displacement at A and as a force at
/// I. The best r brings both to their tolerances at the same time, so r is raised while A is behind and
/// lowered while I is. N and T have a balance each. Usual residual balancing (the whole w − φ against the
/// whole r Δφ) sees the two mixed by over-relaxation: it took 107 iterations where this takes 52 (rocker,
/// elastic, frictionless).
class Balance {
 public:
  explicit Balance(std::size_t points) : free_(points), part_(points) {}

  /// One iteration at contact point i: what is open at a held row, the force still moving at a free one (else
  /// 0).
  void normal(std::size_t i, double held, double free) {
    held_[0] = std::max(held_[0], std::abs(held));
    free_.normal[i] = free;
  }
  void tangential(std::size_t i, double held, std::array<double, 2> free) {
    held_[1] = std::max(held_[1], std::abs(held));
    free_.tangential[2 * i] = free[0];
    free_.tangential[2 * i + 1] = free[1];
  }

  /// Ends an iteration. Collective.
  void finish(const Traces& traces) {
    BalanceSample sample;
    for (std::size_t k = 0; k < 2; ++k) {
      if (k == 0)
        part_.normal = free_.normal;
      else
        part_.tangential = free_.tangential;
      sample.held[k] = traces.ranks().max_all(held_[k]);
      sample.moved[k] = traces.force_norm(part_);
      std::fill(part_.normal.begin(), part_.normal.end(), 0.0);
      std::fill(part_.tangential.begin(), part_.tangential.end(), 0.0);
      held_[k] = 0.0;
    }
    samples_.push_back(sample);
  }

  const std::vector<BalanceSample>& samples() const noexcept { return samples_; }

 private:
  ContactValues free_, part_;
  std::array<double, 2> held_{};
  std::vector<BalanceSample> samples_;
};

/// Mean of log (A behind / I behind) over the iterations, for N and T, with what the traces at A and the
/// forces at I are to be compared with; 0 where nothing was learnt.
inline std::array<double, 2> mean_behind(std::span<const BalanceSample> samples, double trace_scale,
                                         double force_scale) {
  constexpr double most = 3.0;  // where one side is empty the other cannot be infinitely behind
  std::array<double, 2> mean{};
  if (!(trace_scale > 0.0 && force_scale > 0.0)) return mean;
  for (std::size_t k = 0; k < 2; ++k) {
    int count = 0;
    for (const BalanceSample& sample : samples) {
      const double held = sample.held[k] / trace_scale, moved = sample.moved[k] / force_scale;
      if (!(held + moved > 0.0)) continue;
      mean[k] += (std::clamp(std::log(held / moved), -most, most) - mean[k]) / ++count;
    }
  }
  return mean;
}

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
