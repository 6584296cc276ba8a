// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kacanov's or Newton's method round a contact step, until the KKT residuals are small.
#pragma once

#include <optional>
#include <string>

#include <kacanov/coarse_solution.hpp>

#include "nonlinear/augmented_control.hpp"
#include "nonlinear/loop_control.hpp"
#include "nonlinear/step.hpp"
#include "partition/nondimensionalisation.hpp"

namespace kacanov {

/// Solves at one share of the load after the other (theory: kacanov, newton). Everything is collective.
class OuterLoop {
 public:
  /// At rest under `share` of the load. What is passed has to outlive the loop.
  OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run, double share = 1.0,
            const Tuning& tuning = {});

  /// The part's, where they are not the user's: what the loop hands out is in the user's. Before run() and
  /// restore().
  void work_in(const UnitSystem& units) {
    extent_ *= units_.strain() / units.strain();
    units_ = units;
  }
  const UnitSystem& units() const noexcept { return units_; }

  /// Runs until the KKT residuals meet the tolerance, or max_outer steps. Fills the loop's entries of the
  /// result. Where the run is to stop, state and result are those after the last whole outer step, and false
  /// is returned.
  bool run(Result& result);
  /// A state that the loop can start from. `at_rest`: u = 0, which is not in balance.
  struct Place {
    ContactState state;
    double share = 0.0;
    bool at_rest = false;
  };
  Place place() const { return {context_.state, context_.path.share()}; }
  /// Rest, where the load step begins; slip keeps its origin.
  Place rest() const;
  /// The share of the load at which the load step under way begins.
  double step_begin() const;
  /// Where the next load step begins: here, with its slip counted from here.
  Place next_start() const;
  /// Another share of the load: starts from the same multiple of that state (theory: load-path), or, with
  /// load curves or a slip history, from that state itself.
  void go_from(const Place& place, double share, const Result& result);
  /// Just that state, at its share of the load.
  void stand_at(const Place& place, const Result& result);
  /// Whether the last run() ended because more steps promise nothing, and not for their number.
  bool gave_up() const noexcept { return gave_up_; }
  /// Whether the body has left for good, as one that its supports or its material do not hold.
  bool ran_away() const { return ran_away(certify()); }

  /// Starts from what a coarser mesh says (theory: nested). Penalties begin as from rest.
  void adopt(const Start& start);
  /// Another share of the load: goes on from that place, its slip counted as there, with the state that a
  /// coarser mesh has at that share.
  void go_along(const Place& place, double share, const Start& start, const Result& result);
  /// Goes on from a checkpoint, which rank 0 has.
  void restore(const Checkpoint* from, Result& result);
  /// What restore() needs, on rank 0.
  Checkpoint checkpoint(const Result& result) const;

  /// How far a load step has come that may have to be taken in parts; whoever moves the load keeps it, and a
  /// checkpoint has it.
  struct StepParts {
    std::optional<Place> start = {};  ///< of the load step; none: rest
    bool cut = false;                 ///< into parts: the rest has a meaning
    Place last;                       ///< the end of the last part that has converged
    Place whole;                      ///< where the attempt at the whole step has left off
    double over = 0.0, part = 0.5;    ///< of the way from `start`: what lies behind, the part under way
    double next = 0.5;                ///< the end of that
    bool again = false;               ///< a part of this length has converged before
  };
  StepParts parts;

  const StepContext& context() const noexcept { return context_; }
  const ContactState& state() const noexcept { return context_.state; }
  /// Of the steps of the last run().
  const ContactChanges& contact_changes() const noexcept { return changes_; }
  Residuals certify() const { return context_.certify(); }
  /// Of the operator, those before a restart included.
  std::uint64_t applications() const noexcept {
    return earlier_applications_ + context_.body.op().applications();
  }
  double spectrum_seconds() const noexcept { return spectrum_seconds_; }
  double checkpoint_seconds() const noexcept { return checkpoint_seconds_; }

 private:
  struct Interrupted {};  ///< thrown through the loops, on all ranks alike

  /// What decides how the loop goes on besides the state itself.
  struct Control {
    PenaltyControl penalty;
    Linearisation linearisation;
    Fallback fallback;
    AugmentedControl augmented;
  };

  void iterate(Result& result);
  /// Takes the state of rest where that solves the load there is, exactly: what the state before leaves of a
  /// load that is gone sets no scale to converge by.
  void take_rest_if_solution();
  /// Takes the first step as from rest where the state beside what obstacles have moved by is next to rest:
  /// forces and displacements as small as those do not show how exactly to solve.
  void open_if_at_rest(const Residuals& residuals);
  /// The next step, by Newton's method or ADMM, and its counts.
  StepOutcome take_step(bool newton, const Residuals& before, Result& result);
  /// From the residuals after the step; those of the state to go on from are returned.
  Residuals learn(const StepOutcome& step, bool newton, const Residuals& before, const Residuals& after,
                  double lambda_min);
  /// Keeps the state if there has been no better.
  void keep_best(const Residuals& residuals, bool newton);
  /// Goes back to it.
  Residuals go_back();
  bool ran_away(const Residuals& residuals) const;
  /// Why nothing is to be hoped for; empty otherwise.
  std::string hopeless(const Residuals& residuals, bool newton) const;
  void report(const StepOutcome& step, const Residuals& residuals, const Result& result) const;
  void choose_first_penalty(Result& result);
  void move_penalty(const StepOutcome& step, const Residuals& before, const Residuals& after, Result& result);
  /// In the loop's units; its penalties stay.
  void take(const Start& start);
  /// Prescribed components, gaps, traces and bounds of the load there is.
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
  int first_outer_ = 0;             ///< outer steps before this load step, or before a restart
  bool adopted_ = false;            ///< a coarser mesh has given the state
  double coarse_lambda_max_ = 0.0;  ///< and this
  bool opening_ = true;             ///< the next step is the first from rest
  bool within_ = false;             ///< steps have been taken since run() began, before a restart or after
  bool resumes_ = false;            ///< run() has not been called since restore()
  bool gave_up_ = false;
  bool friction_;
  bool history_;            ///< slip of some point is counted from the load step before
  bool stoppable_;          ///< some rank has something to ask whether to stop
  double extent_;           ///< of the body, in the unit of displacements
  double largest_imposed_;  ///< displacement
  UnitSystem units_;
  ContactChanges changes_;
  std::uint64_t earlier_applications_ = 0;
  double spectrum_seconds_ = 0.0, checkpoint_seconds_ = 0.0;

  struct Best {
    ContactState state;
    double worst = HUGE_VAL;
    bool by_multipliers = false;  ///< the end of a retreat so far
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
  std::optional<Kept> kept_;  ///< after the last whole outer step; only where a run may be stopped
};

}  // namespace kacanov
