// SPDX-License-Identifier: BSD-3-Clause
// One step of the outer loop: ADMM on the secant, semismooth Newton, or its augmented form.
#pragma once

#include <cstdint>
#include <memory>

#include <kacanov/run_options.hpp>
#include "contact/active_set.hpp"
#include "nonlinear/augmented_control.hpp"
#include "nonlinear/contact_preconditioner.hpp"

namespace kacanov {

/// What steps work with: the problem, and the state they move.
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
  std::shared_ptr<ResidualWeights> weights;  ///< the space's; null where the body is one region
  BodyResponse body;
  /// Of the temperature at the current load; set by take_temperature().
  std::vector<double> thermal_pressure, free_strain;
  Vector expansion;  ///< its part of F; empty: none
  double expansion_energy = 0.0;
  ContactPreconditioner preconditioner;
  LinearProblem secant, tangent;  ///< by what `body` has frozen
  ContactState state;
  CgWork work;
  Vector volume;  ///< lumped, of each node; with the paper's stop only

  /// Evaluates the temperature of the current load. Collective.
  void take_temperature();
  /// KKT residuals of the state, by the loop's own operator (theory: kkt); the space's weights are from then
  /// on those of this state. Collective.
  Residuals certify() const;
  /// The same by another operator's R(u) and energy; `dilatation`: corner_dilatation() of the state.
  Residuals certify(std::span<const double> internal, double energy,
                    std::span<const double> dilatation) const;
};

/// No multipliers, and the displacement to start from.
void put_to_rest(const Part& part, ContactState& state);

struct StepOutcome {
  const char* method = "";
  int contact_iterations = 0;
  std::int64_t cg_iterations = 0;
  std::uint64_t applications = 0;      ///< of the operator in those
  bool solved = true;                  ///< every linear problem was
  double length = 1.0;                 ///< of a Newton step: how much of it was taken
  bool tangent = false;                ///< of a Newton step: by the tangent, not the secant
  bool arrived = false;                ///< an ADMM step but the first brought the first pressure
  std::vector<BalanceSample> balance;  ///< of an ADMM step, one an iteration
};

/// Kačanov's step (theory: kacanov): freezes the secant and takes the contact loop some way (theory: admm,
/// dual-admm). `before`: of the state it starts from; `first`: the elastic step of a run. Collective.
StepOutcome admm_step(StepContext& c, const Penalty& penalty, const Residuals& before, bool first);

/// A semismooth Newton step (theory: active-set), damped (theory: damping), by the tangent or the secant.
/// `penalty`: that of N, which decides the set. Where it is not solved, the state stays. Collective.
StepOutcome newton_step(StepContext& c, double penalty, bool tangent, const Residuals& before);

/// Minimises stored energy, load and what contact adds at the multipliers and bounds of the state
/// (theory: augmented-newton), by semismooth Newton steps with a line search: each lowers it, wherever it
/// starts. The multipliers move on at the end. R(u) and the secant have to be those of the state, and are
/// afterwards. Collective.
StepOutcome augmented_step(StepContext& c, AugmentedControl& control, const Residuals& before);

}  // namespace kacanov
