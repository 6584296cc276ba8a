// SPDX-License-Identifier: BSD-3-Clause
// The numbers that steer the outer loop, each with what was measured for it.
#pragma once

#include <cstdint>

namespace kacanov {

/// Nobody but tests and experiments changes them. Applications are those of the operator, over whole runs.
struct Tuning {
  // How exactly a step is solved.

  /// The contact loop of an ADMM step is taken this far below the residual of the step before; the first one,
  /// which is elastic, as well. A half there leaves slip on fine meshes to Newton steps that move it on by a
  /// few rows of nodes each, a tenth costs more than it saves.
  double inner_reduction = 0.2;
  /// ADMM iterations of the first step where Newton steps follow: it is to guess who touches. A slender
  /// cantilever that just reaches its obstacle took 10,000 for the same answer.
  int opening_iterations = 20;
  /// Of the first residual of a semismooth Newton step. One that would end within `last_reach` of
  /// `last_share` of the tolerance goes on to there: it may be the last then, and digits cost more in a step
  /// of their own (87 cases: 8,071 applications and 554 steps in place of 8,448 and 606).
  double solve_reduction = 0.03;
  double last_reach = 100.0, last_share = 0.7;
  /// What a step leaves out is asked for at this share of its first residual, where that can save so many
  /// iterations, and the solve stops at this share of it.
  double left_out_asked = 0.2, left_out_worth = 2.0, left_out_share = 0.7;

  // Linearisation (theory: newton, damping).

  /// Residual of equilibrium up to which steps take the tangent: that of a state further off sends them too
  /// far, and contact and slip with them.
  double first_reach = 0.3;
  /// Where a tangent has gone too far the reach becomes this share of the residual it started from ...
  double reach_cut = 0.5;
  /// ... but not less than this: below it is contact that goes to and fro, not the tangent.
  double least_reach = 0.003;
  int max_damping_trials = 6;
  /// A step that leaves half of its slope is too short, and goes on up to so many times itself, where its
  /// rows are closed but for this share of it: the secant of a body far beyond yield lags behind by orders of
  /// magnitude.
  double longest_step = 1e6, closed_rows = 1e-6;
  /// A tangent step of which less was taken is followed by one of the secant.
  double short_step = 0.1;

  // Penalties (theory: first-penalty, balance).

  /// First one, times λ_min over the root of the mesh width relative to the contact surface. Three times as
  /// much is as good for beams, and worse for the half ball; a third costs a few per cent more applications.
  double first_penalty = 0.1;
  /// CG iterations of a rough estimate of λ_max.
  int rough_iterations = 2;
  /// ADMM iterations between two looks at the balance (and, in Kacanov's method, at g) after the first step.
  /// Ten take 6 % more of them; with three, penalties that follow Coulomb's bounds kept one beam from
  /// converging.
  int balancing_iterations = 5;
  /// A step of fewer iterations moves the penalties by less.
  double trusted_iterations = 4.0;
  /// Penalties stay between this over λ_min, which contracts errors at held rows to a quarter (more costs CG
  /// iterations), and that share of it.
  double largest_penalty = 3.0, smallest_share = 1e-4;
  /// Semismooth Newton decides by λ + c(w − ρ), c this share of ADMM's penalty. A whole penalty makes
  /// slipping points flip on the half ball (338 applications instead of 145), a tenth costs steps on beams.
  double decision_share = 0.3;

  // The method of multipliers (theory: augmented-newton).

  /// Largest penalty over 1/λ_min.
  double augmented_penalty = 10.0;
  /// It grows by so much where a round takes so few Newton steps, and falls by it where it takes so many.
  double augmented_change = 3.0;
  int augmented_few = 3, augmented_many = 8;
  /// How far the second round's multipliers follow the first's; from then on Anderson's acceleration knows.
  double augmented_following = 0.5;
  /// Rounds that it remembers.
  int augmented_memory = 6;
  /// What is left unbalanced, as a share of the force that the multipliers move by.
  double augmented_balance = 0.03;
  /// Newton steps between two moves of the multipliers.
  int augmented_iterations = 10;
  /// Share of the penalty on all rows where contact alone holds motions.
  double loose_share = 1e-5;

  // When a preconditioner is set up again.

  /// Once a step needs this many CG iterations more than it would have right after the last setup: half of
  /// what a setup costs.
  double setup_worth = 4.0;
  /// Before a step where g has moved by this share in the mean.
  double drift_worth = 0.05;
  /// Where a penalty, or how stiff a slip is, has moved by this factor (elastic beam, ADMM: 144 applications
  /// instead of 212).
  double penalty_worth = 3.0;

  /// Changes of the held rows between two setups with g: what a restart repeats, and a checkpoint holds.
  std::size_t most_changes = 64;

  /// A solve of so many CG iterations asks for a factor, or of as many as a factor takes the time of:
  /// `factor_iterations` for a body of `factor_unknowns`, growing with this power of them (3,000 for 9,800),
  /// in a body of at most `most_factorised` unknowns.
  double most_iterations = 500.0;
  double factor_iterations = 250.0, factor_unknowns = 2160.0, factor_growth = 1.64;
  std::int64_t most_factorised = 10'000;

  // From Newton steps back to ADMM (theory: active-set), and giving up.

  /// A Newton step below this share of the best residual is a new best; `patience` steps without one are
  /// enough.
  double progress = 0.7;
  int patience = 6;
  /// ADMM hands back early at this share of the best residual of the Newton steps before.
  double retreat_gain = 0.1;
  /// ADMM steps of the first retreat; each is twice as long as the one before, so many times.
  int first_retreat = 2, most_doublings = 6;
  /// After so many steps without a residual below this share of the lowest the load is cut.
  int most_idle = 40;
  double gain = 0.7;
  /// A step of a retreat whose linear problem has no solution counts for so many of those: the next starts
  /// from the same state.
  int unsolved_worth = 8;
  /// The smallest part of a load step that is tried.
  double smallest_part = 1.0 / 64;
  /// A displacement of this many body sizes is a run that goes nowhere.
  double most_displacement = 1e7;

  /// Operator applications between two looks at whether the run is to stop, which cost a reduction.
  std::uint64_t applications_per_question = 4;
};

}  // namespace kacanov
