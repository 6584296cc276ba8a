// SPDX-License-Identifier: BSD-3-Clause
// One step of the outer loop: ADMM with the secant, semismooth Newton, or the method of multipliers.
#pragma once

#include <cstdint>
#include <memory>

#include <kacanov/run_options.hpp>
#include "contact/active_set.hpp"
#include "nonlinear/augmented_control.hpp"
#include "nonlinear/contact_preconditioner.hpp"

namespace kacanov {

/// Context of the steps: the problem, and the state that they change.
struct StepContext {
  StepContext(const Part& part, const SolverOptions& options, const RunOptions& run, const Tuning& tuning);
  StepContext(const StepContext&) = delete;
  StepContext& operator=(const StepContext&) = delete;

  const Part& part;
  const SolverOptions& options;
  Tuning tuning;
  LoadPath path;
  Space space;
  Traces traces;
  StiffnessRegions regions;
  std::shared_ptr<ResidualWeights> weights;  ///< weights of `space`; null for a body of one region
  BodyResponse body;
  /// Thermal pressure and free strain at the current load; set by take_temperature().
  std::vector<double> thermal_pressure, free_strain;
  Vector expansion;  ///< thermal part of F; empty: none
  double expansion_energy = 0.0;
  ContactPreconditioner preconditioner;
  LinearProblem secant, tangent;  ///< with the operator frozen in `body`
  ContactState state;
  CgWork work;
  Vector volume;  ///< lumped, per node; only with the paper's stop

  /// Computes the thermal terms of the current load. Collective.
  void take_temperature();
  /// Returns the KKT residuals of the state with the loop's own operator (theory: kkt); sets the weights of
  /// `space` to those of this state. Collective.
  Residuals certify() const;
  /// The same with R(u) and energy of another operator; `dilatation`: corner_dilatation() of the state.
  Residuals certify(std::span<const double> internal, double energy,
                    std::span<const double> dilatation) const;
};

/// Sets all multipliers to zero, and u to the start displacement.
void put_to_rest(const Part& part, ContactState& state);

struct StepOutcome {
  const char* method = "";
  int contact_iterations = 0;
  std::int64_t cg_iterations = 0;
  std::uint64_t applications = 0;  ///< operator applications
  bool solved = true;              ///< whether all linear problems were solved
  double length = 1.0;             ///< accepted length of a Newton step
  bool tangent = false;            ///< whether a Newton step used the tangent, not the secant
  bool arrived = false;            ///< whether an ADMM step other than the first brought the first pressure
  std::vector<BalanceSample> balance;  ///< of an ADMM step, one entry per iteration
  PenaltyEvidence evidence;            ///< of an ADMM step, if a published rule chooses the penalty
};

/// Kačanov's step (theory: kacanov): freezes the secant and runs the contact loop to a limited accuracy
/// (theory: admm, dual-admm). `before`: residuals of the initial state; `first`: the elastic step of a run.
/// Collective.
StepOutcome admm_step(StepContext& c, const Penalty& penalty, const Residuals& before, bool first);

/// A semismooth Newton step (theory: active-set), damped (theory: damping), with the tangent or the secant.
/// `penalty`: that of N, which decides the active set. If the linear problem is not solved, the state does
/// not change. Collective.
StepOutcome newton_step(StepContext& c, double penalty, bool tangent, const Residuals& before);

/// Minimises the augmented Lagrangian at the multipliers and bounds of the state (theory: augmented-newton)
/// by semismooth Newton steps with a line search, each a descent from any start; then updates the
/// multipliers. R(u) and the secant must be those of the state, before and after. Collective.
StepOutcome augmented_step(StepContext& c, AugmentedControl& control, const Residuals& before);

}  // namespace kacanov
