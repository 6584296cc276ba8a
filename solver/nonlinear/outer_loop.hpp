// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kacanov's or Newton's method round a contact step, until the KKT residuals are small.
#pragma once

#include <optional>
#include <string>

#include <kacanov/coarse_solution.hpp>

#include "nonlinear/fallback.hpp"
#include "nonlinear/linearisation.hpp"
#include "nonlinear/penalty_control.hpp"
#include "nonlinear/step.hpp"

namespace kacanov {

/// Solves at one share of the load after the other (theory: kacanov, newton). Everything is collective.
class OuterLoop {
 public:
  /// At rest under `share` of the load. What is passed has to outlive the loop.
  OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run, double share = 1.0,
            const Tuning& tuning = {});

  /// Runs until the KKT residuals meet the tolerance, or max_outer steps. Fills the loop's entries of the
  /// result. Where the run is to stop, state and result are those after the last whole outer step, and false
  /// is returned.
  bool run(Result& result);
  /// Another share of the load: starts from the same multiple of the state there is (theory: load-path), or,
  /// with load curves or a slip history, from that state itself.
  void go_to(double share, const Result& result);

  /// Starts from what a coarser mesh says (theory: nested). Penalties begin as from rest.
  void adopt(const Start& start);
  /// Goes on from a checkpoint, which rank 0 has.
  void restore(const Checkpoint* from, Result& result);
  /// What restore() needs, on rank 0.
  Checkpoint checkpoint(const Result& result) const;

  const StepContext& context() const noexcept { return context_; }
  const ContactState& state() const noexcept { return context_.state; }
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
  };

  void iterate(Result& result);
  /// The next step, by Newton's method or ADMM, and its counts.
  StepOutcome take_step(bool newton, const Residuals& before, Result& result);
  void learn(const StepOutcome& step, bool newton, const Residuals& before, const Residuals& after);
  /// Why nothing is to be hoped for; empty otherwise.
  std::string hopeless(const Residuals& residuals, bool newton) const;
  void report(const StepOutcome& step, const Residuals& residuals, const Result& result) const;
  void choose_first_penalty(Result& result);
  void move_penalty(const StepOutcome& step, const Residuals& before, const Residuals& after, Result& result);
  /// Prescribed components, gaps, traces and bounds of the load there is.
  void take_load();
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
  bool friction_;
  bool history_;   ///< slip of some point is counted from the load step before
  double extent_;  ///< of the body
  std::uint64_t earlier_applications_ = 0;
  double spectrum_seconds_ = 0.0, checkpoint_seconds_ = 0.0;

  struct Kept {
    ContactState state;
    Control control;
    Result result;
  };
  std::optional<Kept> kept_;  ///< after the last whole outer step; only where a run may be stopped
};

}  // namespace kacanov
