// SPDX-License-Identifier: BSD-3-Clause
// ADMM for contact (paper, Algorithm 1), and its residual balancing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include <kacanov/model.hpp>
#include "contact/contact_state.hpp"
#include "contact/penalty_rules.hpp"
#include "contact/traces.hpp"
#include "multigrid/cg.hpp"

namespace kacanov {

/// Balance data of one iteration, for N and T: the largest open displacement at the held rows A (touching,
/// sticking and, in 3D, across the slip), and the norm of the force change at the free rows I.
struct BalanceSample {
  std::array<double, 2> held{}, moved{};
};

/// A larger r speeds up errors at A (displacements, factor 1/(1 + r λ(K_AA)) per iteration) and slows down
/// those at I (forces, r λ(K_I|A)/(1 + r λ(K_I|A))); the best r brings both to tolerance together. Balancing
/// w − φ against r Δφ mixes them by over-relaxation: 107 iterations, not 52 (rocker, elastic, frictionless).
class Balance {
 public:
  explicit Balance(std::size_t points) : free_(points), part_(points) {}

  /// Adds contact point i of one iteration: the open displacement of a held row, or the force change of a
  /// free one (the other is 0).
  void normal(std::size_t i, double held, double free) {
    held_[0] = std::max(held_[0], std::abs(held));
    free_.normal[i] = free;
  }
  void tangential(std::size_t i, double held, std::array<double, 2> free) {
    held_[1] = std::max(held_[1], std::abs(held));
    free_.tangential[2 * i] = free[0];
    free_.tangential[2 * i + 1] = free[1];
  }

  /// Ends the current iteration. Collective.
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

/// Returns the mean of log (lag of A / lag of I) over the iterations, for N and T, relative to the given
/// scales of traces and forces; 0 without data.
inline std::array<double, 2> mean_behind(std::span<const BalanceSample> samples, double trace_scale,
                                         double force_scale) {
  constexpr double most = 3.0;  // limit where one side has no rows
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

/// A linearised problem: the frozen B, and its preconditioner for B + r CᵀMC.
struct LinearProblem {
  const Space* space = nullptr;
  const Traces* traces = nullptr;
  /// y = B x, consistent; returns this rank's share of xᵀ y.
  std::function<double(std::span<const double>, std::span<double>)> apply;
  std::function<void(std::span<const double>, std::span<double>)> precondition;  ///< z ≈ (B + r CᵀMC)⁻¹ r
  /// Penalty on slip in the preconditioner of Newton steps with sliding friction, if contact alone holds
  /// rigid-body modes.
  double loose = 0.0;
  /// f = F − R(u) at the linearisation point, for Newton steps.
  std::function<void(std::span<double>)> pull = {};
  /// f = F − R(u) at any u, for bodies with a nonlinear response. Collective.
  std::function<void(std::span<const double>, std::span<double>)> unbalanced = {};
};

struct AdmmOptions {
  Penalty r;
  double relaxation = 1.0;       ///< α: Nu is replaced by α Nu + (1 − α) φ in steps 2 and 3
  double force_tolerance = 0.0;  ///< absolute, on the residual of the linear equilibrium
  double force_reduction = 0.0;  ///< or relative to the contact force, if nothing else sets a scale
  double contact_weight = 1.0;   ///< weight of contact forces relative to residuals (Scales::contact_weight)
  double trace_tolerance = 0.0;  ///< absolute, on max |Cu − φ|
  int max_iterations = 10000;
  int max_cg = SolverOptions{}.max_cg;  ///< CG iterations per solve
  /// Points under pressure with Coulomb friction stick, whatever their bound.
  bool sticking = false;
  /// If ε > 0, stops by the size of steps (theory: step-stop), with solves to the tolerances above.
  double step_tolerance = 0.0;
  bool collect_evidence = false;   ///< whether the result holds what penalty rules need
  std::span<const double> volume;  ///< lumped volume of each node, for the L² norm of that criterion
};

struct AdmmResult {
  int iterations = 0;
  std::int64_t cg_iterations = 0;
  double cg_digits = 0.0;              ///< decimal digits gained by all solves
  double force_residual = 0.0;         ///< residual norm of the linear equilibrium with the new multipliers
  double trace_residual = 0.0;         ///< max |Cu − φ|
  std::vector<BalanceSample> balance;  ///< one per iteration
  PenaltyEvidence evidence;            ///< of the last iteration, if collected
  double step = 0.0;                   ///< ‖change‖ / ‖state‖ of the criterion by steps
  bool converged = false;
  bool solves_converged = true;
};

/// Tolerances of a solve: reducing the first residual, caused by the last projection, to a tenth suffices
/// (inexact ADMM) unless the loop stops by steps.
inline CgOptions solve_options(const AdmmOptions& options) {
  return {0.2 * options.force_tolerance, options.step_tolerance > 0.0 ? 1e-12 : 0.1, options.max_cg};
}

/// Whether the residuals of `result` meet the tolerances for the current `lambda`.
inline bool meets_tolerances(const AdmmResult& result, const AdmmOptions& options, const Traces& traces,
                             const ContactValues& lambda) {
  const double enough = options.force_reduction > 0.0
                            ? options.force_reduction * options.contact_weight * traces.force_norm(lambda)
                            : 0.0;
  return result.force_residual <= std::max(options.force_tolerance, enough) &&
         result.trace_residual <= options.trace_tolerance;
}

/// Iterates until both tolerances (or the criterion by steps) are met. On entry `work.residual` holds F −
/// R(u) − CᵀMλ for the linearisation at state.u; on exit the same with the frozen B (up to held components).
AdmmResult admm(const LinearProblem& problem, ContactState& state, CgWork& work, const AdmmOptions& options);

}  // namespace kacanov
