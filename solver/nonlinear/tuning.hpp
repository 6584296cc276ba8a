// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the outer loop, each with the measurement behind its value.
#pragma once

#include <cstdint>

namespace kacanov {

/// Only tests and experiments change these values. "Applications" are operator applications of whole runs.
struct Tuning {
  // Accuracy of a step.

  /// The contact loop of an ADMM step, including the first, elastic one, stops at this share of the previous
  /// residual. With 0.5, slip on fine meshes is left to Newton steps that advance it by a few rows of nodes
  /// each; 0.1 costs more than it saves.
  double inner_reduction = 0.2;
  /// ADMM iterations of the first step if Newton steps follow: it only has to guess the contact set. A
  /// slender cantilever that just reaches its obstacle took 10,000 iterations for the same answer.
  int opening_iterations = 20;
  /// Residual reduction of a Newton solve. If the target is within a factor `last_reach` of `last_share`
  /// times the tolerance, the solve continues to the latter: the step may be the last, and digits cost more
  /// in a separate step (87 cases: 8,071 applications and 554 steps instead of 8,448 and 606).
  double solve_reduction = 0.03;
  double last_reach = 100.0, last_share = 0.7;
  /// The linearisation error is evaluated once the residual is below this share of the first one and at least
  /// this many iterations can be saved; the solve stops at this share of it.
  double left_out_asked = 0.2, left_out_worth = 2.0, left_out_share = 0.7;

  // Linearisation (theory: newton, damping).

  /// Largest equilibrium residual at which steps use the tangent: farther from equilibrium it overshoots,
  /// with contact and slip.
  double first_reach = 0.3;
  /// After a tangent step that overshot, the reach becomes this share of the residual before it ...
  double reach_cut = 0.5;
  /// ... but at least this value, below which contact oscillates and not the tangent.
  double least_reach = 0.003;
  int max_damping_trials = 6;
  /// A step that leaves half of its initial slope is too short and is extended up to this factor, if the rows
  /// it closes are closed up to this share of it: far beyond yield the secant lags behind by orders of
  /// magnitude.
  double longest_step = 1e6, closed_rows = 1e-6;
  /// After a tangent step shortened below this length, the next step uses the secant.
  double short_step = 0.1;

  // Penalties (theory: first-penalty, balance).

  /// First penalty, relative to λ_min and the root of the mesh width relative to the contact surface. Three
  /// times as much is equally good for beams and worse for the half ball; a third costs a few per cent more
  /// applications.
  double first_penalty = 0.1;
  /// CG iterations for a rough estimate of λ_max.
  int rough_iterations = 2;
  /// ADMM iterations between two updates of the balance (and, in Kačanov's method, of g) after the first
  /// step. Ten take 6 % more iterations; with three, penalties that follow Coulomb's bounds kept one beam
  /// from converging.
  int balancing_iterations = 5;
  /// Steps with fewer iterations change the penalties less.
  double trusted_iterations = 4.0;
  /// Penalties are at most this over λ_min, which contracts errors at held rows to a quarter (more costs CG
  /// iterations), and at least that share of it.
  double largest_penalty = 3.0, smallest_share = 1e-4;
  /// Semismooth Newton decides by λ + c(w − ρ), with c this share of ADMM's penalty. The whole penalty makes
  /// slipping points flip on the half ball (338 applications instead of 145); a tenth costs steps on beams.
  double decision_share = 0.3;

  // The method of multipliers (theory: augmented-newton); an outer iteration of it is called a round.

  /// Largest penalty, times λ_min.
  double augmented_penalty = 10.0;
  /// The penalty is multiplied by this after a round with at most `few` Newton steps, and divided by it after
  /// one with at least `many`.
  double augmented_change = 3.0;
  int augmented_few = 3, augmented_many = 8;
  /// Relaxation of the multiplier update before the second round; later rounds use Anderson acceleration.
  double augmented_following = 0.5;
  /// Depth of the Anderson acceleration.
  int augmented_memory = 6;
  /// Remaining unbalanced force of a round relative to the force change by the multiplier update.
  double augmented_balance = 0.03;
  /// Maximum number of Newton steps per round.
  int augmented_iterations = 10;
  /// Share of the penalty applied to all rows if contact alone holds rigid-body modes.
  double loose_share = 1e-5;

  // Conditions for a new setup of the preconditioner.

  /// If a step needs this many CG iterations more than right after the last setup: half the cost of a setup.
  double setup_worth = 4.0;
  /// If the mean relative change of g before a step exceeds this share.
  double drift_worth = 0.05;
  /// If a penalty or a slip stiffness has changed by this factor (elastic beam, ADMM: 144 applications
  /// instead of 212).
  double penalty_worth = 3.0;

  /// Changes of the held rows between two setups with new g; a restart repeats them, and a checkpoint stores
  /// them.
  std::size_t most_changes = 64;

  /// A solve with more CG iterations than this triggers a sparse factor, or with more than take the time of a
  /// factor: `factor_iterations` for `factor_unknowns` unknowns, growing with this power (3,000 for 9,800),
  /// for bodies of at most `most_factorised` unknowns.
  double most_iterations = 500.0;
  double factor_iterations = 250.0, factor_unknowns = 2160.0, factor_growth = 1.64;
  std::int64_t most_factorised = 10'000;

  // Fallback from Newton steps to the method of multipliers (theory: active-set), and termination.

  /// A Newton step below this share of the best residual is a new best; after `patience` steps without one a
  /// retreat begins.
  double progress = 0.7;
  int patience = 6;
  /// A retreat ends early at this share of the best residual of the preceding Newton steps.
  double retreat_gain = 0.1;
  /// Steps of the first retreat; each retreat is twice as long as the one before, for at most this many
  /// doublings.
  int first_retreat = 2, most_doublings = 6;
  /// The load step is cut after this many steps without a residual below `gain` times the lowest.
  int most_idle = 40;
  double gain = 0.7;
  /// A retreat step with an unsolvable linear problem counts as this many of those steps, because the next
  /// one starts from the same state.
  int unsolved_worth = 8;
  /// Smallest part of a load step that is attempted.
  double smallest_part = 1.0 / 64;
  /// A run with a displacement above this many body sizes is diverging.
  double most_displacement = 1e7;

  /// Operator applications between two checks for a stop request, each of which costs a reduction.
  std::uint64_t applications_per_question = 4;
};

}  // namespace kacanov
