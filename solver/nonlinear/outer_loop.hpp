// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kačanov's or Newton's method around a contact step, until the KKT residuals are small.
#pragma once

#include <optional>
#include <string>

#include <kacanov/coarse_solution.hpp>

#include "nonlinear/augmented_control.hpp"
#include "nonlinear/loop_control.hpp"
#include "nonlinear/step.hpp"
#include "partition/nondimensionalisation.hpp"

namespace kacanov {

/// Solves at successive shares of the load (theory: kacanov, newton). All members are collective.
class OuterLoop {
 public:
  /// Starts at rest under `share` of the load. All arguments must outlive the loop.
  OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run, double share = 1.0,
            const Tuning& tuning = {});

  /// Sets the part's units if they are not the user's: the loop reports in the user's units. Call it before
  /// run() and restore().
  void work_in(const UnitSystem& units) {
    extent_ *= units_.strain() / units.strain();
    units_ = units;
  }
  const UnitSystem& units() const noexcept { return units_; }

  /// Runs until the KKT residuals meet the tolerance, or for max_outer steps. Fills the loop's entries of the
  /// result. On a stop request returns false, with state and result after the last completed outer step.
  bool run(Result& result);
  /// A state from which the loop can start. `at_rest`: u = 0, not in equilibrium.
  struct Place {
    ContactState state;
    double share = 0.0;
    bool at_rest = false;
  };
  Place place() const { return {context_.state, context_.path.share()}; }
  /// Returns the state of rest at the start of the load step; slip keeps its origin.
  Place rest() const;
  /// Returns the share of the load at which the current load step begins.
  double step_begin() const;
  /// Returns the start of the next load step: the current state, with slip measured from it.
  Place next_start() const;
  /// Moves to another share of the load: starts from `place` scaled in proportion (theory: load-path), or
  /// unscaled with load curves or a slip history.
  void go_from(const Place& place, double share, const Result& result);
  /// Restores the state of `place` at its share of the load.
  void stand_at(const Place& place, const Result& result);
  /// Whether the last run() stopped for lack of progress, not because of its number of steps.
  bool gave_up() const noexcept { return gave_up_; }
  /// Whether the body has moved away because supports or material do not hold it.
  bool ran_away() const { return ran_away(certify()); }

  /// Starts from the solution of a coarser mesh (theory: nested). Penalties begin as from rest.
  void adopt(const Start& start);
  /// Moves to another share of the load with the coarser mesh's state at that share; slip is measured as in
  /// `place`.
  void go_along(const Place& place, double share, const Start& start, const Result& result);
  /// Continues from a checkpoint, which rank 0 has.
  void restore(const Checkpoint* from, Result& result);
  /// Returns on rank 0 the checkpoint for restore().
  Checkpoint checkpoint(const Result& result) const;

  /// Progress of a load step that may be cut into parts; maintained by the load-step driver and saved in
  /// checkpoints.
  struct StepParts {
    std::optional<Place> start = {};  ///< of the load step; empty: rest
    bool cut = false;  ///< whether it is cut into parts; otherwise the following members are unused
    Place last;        ///< end of the last converged part
    Place whole;       ///< end of the attempt at the whole step
    double over = 0.0, part = 0.5;  ///< fractions of the load step: completed, and length of the current part
    double next = 0.5;              ///< end of the current part
    bool again = false;             ///< whether a part of this length has converged before
  };
  StepParts parts;

  const StepContext& context() const noexcept { return context_; }
  const ContactState& state() const noexcept { return context_.state; }
  /// Contact changes in the steps of the last run().
  const ContactChanges& contact_changes() const noexcept { return changes_; }
  Residuals certify() const { return context_.certify(); }
  /// Operator applications, including those before a restart.
  std::uint64_t applications() const noexcept {
    return earlier_applications_ + context_.body.op().applications();
  }
  double spectrum_seconds() const noexcept { return spectrum_seconds_; }
  double checkpoint_seconds() const noexcept { return checkpoint_seconds_; }

 private:
  struct Interrupted {};  ///< thrown through nested loops, on all ranks

  /// All that controls the further iterations, apart from the state.
  struct Control {
    PenaltyControl penalty;
    Linearisation linearisation;
    Fallback fallback;
    AugmentedControl augmented;
  };

  void iterate(Result& result);
  /// Takes the state of rest if it solves the current load exactly: the residual forces of a removed load
  /// give no scale for convergence.
  void take_rest_if_solution();
  /// Takes the first step as from rest if the state is negligible relative to the motion of the obstacles,
  /// because such small forces and displacements give no scale for the accuracy of solves.
  void open_if_at_rest(const Residuals& residuals);
  /// Takes the next step, by Newton's method, ADMM or the method of multipliers, and adds its counts.
  StepOutcome take_step(bool newton, const Residuals& before, Result& result);
  /// Updates the controls from the residuals after the step; returns those of the state to continue from.
  Residuals learn(const StepOutcome& step, bool newton, const Residuals& before, const Residuals& after,
                  double lambda_min);
  /// Stores the state if it is the best so far.
  void keep_best(const Residuals& residuals, bool newton);
  /// Restores the best state.
  Residuals go_back();
  bool ran_away(const Residuals& residuals) const;
  /// Explains why further steps are pointless; empty if they are not.
  std::string hopeless(const Residuals& residuals, bool newton) const;
  void report(const StepOutcome& step, const Residuals& residuals, const Result& result) const;
  void choose_first_penalty(Result& result);
  void move_penalty(const StepOutcome& step, const Residuals& before, const Residuals& after, Result& result);
  /// Sets the state, in the loop's units; penalties are unchanged.
  void take(const Start& start);
  /// Applies prescribed components, gaps, traces and bounds of the current load.
  void take_load();
  void restore_penalty(double rule, Penalty penalty, const Result& result);
  void stand_in_parts();
  void keep(const Result& result);
  bool stop_agreed() const;

  const SolverOptions& options_;
  const RunOptions& run_;
  double start_;
  StepContext context_;
  Control control_;
  int first_outer_ = 0;             ///< outer steps before this load step or a restart
  bool adopted_ = false;            ///< whether the state comes from a coarser mesh
  double coarse_lambda_max_ = 0.0;  ///< and its λ_max
  bool opening_ = true;             ///< whether the next step is the first from rest
  bool within_ = false;   ///< whether steps have been taken since run() began, before a restart or after
  bool resumes_ = false;  ///< whether run() has not been called since restore()
  bool gave_up_ = false;
  bool friction_;
  bool history_;            ///< whether slip of some point is measured from the previous load step
  bool stoppable_;          ///< whether some rank has a stop callback
  double extent_;           ///< of the body, in units of displacement
  double largest_imposed_;  ///< largest imposed displacement
  UnitSystem units_;
  ContactChanges changes_;
  std::uint64_t earlier_applications_ = 0;
  double spectrum_seconds_ = 0.0, checkpoint_seconds_ = 0.0;

  struct Best {
    ContactState state;
    double worst = HUGE_VAL;
    bool by_multipliers = false;  ///< whether it is the end of a retreat so far
  };
  Best best_;  ///< of this load step

  struct Kept {
    ContactState state;
    Control control;
    Result result;
    ContactPreconditioner::Memory preconditioner;
    BodyResponse::Frozen frozen;
    bool opening = true, adopted = false;
  };
  BodyResponse::Frozen frozen() const { return stopped_ ? kept_->frozen : context_.body.frozen(); }
  bool stopped_ = false;      ///< by a request; the state is that of kept_
  std::optional<Kept> kept_;  ///< after the last completed outer step; only if a run may be stopped
};

}  // namespace kacanov
