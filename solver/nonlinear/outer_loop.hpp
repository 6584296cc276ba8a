// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kacanov's method (7) or Newton's round a contact step, with the penalty and preconditioner
// it needs.
#pragma once

#include <cmath>
#include <memory>

#include <kacanov/solve.hpp>
#include "contact/active_set.hpp"
#include "contact/certificate.hpp"
#include "spectrum/spectrum.hpp"

namespace kacanov {

/// What decides how the loop goes on besides the state itself. A checkpoint holds every entry: `visit` names
/// them.
struct LoopState {
  double best = HUGE_VAL;  ///< smallest residual since the last retreat
  int stalled = 0;         ///< Newton steps without a new best residual
  int retreat = 0;         ///< ADMM steps still to take
  double aim = 0.0;        ///< residual at which they end early
  int retreats = 0;
  int first_outer = 0;  ///< outer steps before this load step, or before a restart
  double reach = 0.3;   ///< residual of equilibrium up to which steps take the tangent

  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("best", best);
    entry("stalled", stalled);
    entry("retreat", retreat);
    entry("aim", aim);
    entry("retreats", retreats);
    entry("first_outer", first_outer);
    entry("reach", reach);
  }
};

/// Everything a run works with, and the state it leaves.
class OuterLoop {
 public:
  OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run);

  /// Runs until the certificate meets the tolerance, or max_outer steps. Fills the loop's entries of the
  /// result. Where the run is to stop, state and result are those after the last whole outer step, and false
  /// is returned.
  bool run(Result& result);
  /// After the part's loads have been multiplied by `ratio`: starts the next load step from the same multiple
  /// of the last one's solution.
  void scale(double ratio, const Result& result);
  /// By the loop's own operator.
  Residuals certify() const;
  /// Goes on from a checkpoint, which rank 0 has. Collective.
  void restore(const Checkpoint* from, Result& result);
  /// What restore() needs, on rank 0. Collective.
  Checkpoint checkpoint(const Result& result) const;

  const ContactState& state() const noexcept { return state_; }
  std::span<const float> diagonal() const noexcept { return diagonal_; }
  const Space& space() const noexcept { return space_; }
  const Traces& traces() const noexcept { return traces_; }
  const DistributedOperator& op() const noexcept { return op_; }
  /// Of the operator, those before a restart included.
  std::uint64_t applications() const noexcept { return earlier_applications_ + op_.applications(); }
  double spectrum_seconds() const noexcept { return spectrum_seconds_; }
  double checkpoint_seconds() const noexcept { return checkpoint_seconds_; }
  double setup_seconds() const noexcept { return amg_->setup_seconds(); }

 private:
  struct Interrupted {};  ///< thrown through the loops, on all ranks alike
  void iterate(Result& result);
  void keep(const Result& result);
  bool stop_agreed() const;
  void choose_first_penalty(Result& result);
  /// From the stiffness and the number of the contact nodes, without a solve.
  double rough_penalty() const;
  /// Whether any point is under pressure. Collective.
  bool touches() const;
  /// After a step; `arrived` if it was the one that brought the first contact, after others without any.
  void balance_penalty(const AdmmResult& step, bool arrived, const Scales& scales, Result& result);
  /// With the g that the operator has frozen if that of the last setup is `worn`, else with that.
  void set_up_preconditioner(bool worn, std::span<const NodeBlock> blocks, const Space& space);
  Vector secant() const;
  std::vector<NodeBlock> penalty_blocks() const;
  void update_residual();
  void take_unbalanced();
  bool setup_pays();
  bool penalty_moved() const;
  bool set_moved(std::span<const TraceChoice> set) const;
  void watch_preconditioner(double digits, std::int64_t iterations);
  double update_bounds();
  void take_gaps();
  void take_admm_step(Result& result, ProgressStep& line, const Residuals& before);
  void take_newton_step(Result& result, ProgressStep& line, const Residuals& before);
  void take_damped_step(std::span<const double> delta, double curvature);
  void report(const ProgressStep& step) const;

  const Part& part_;
  const SolverOptions& options_;
  const RunOptions& run_;
  double start_;
  Space space_;
  Traces traces_;
  DistributedOperator op_;
  std::unique_ptr<Preconditioner> amg_;
  ContactState state_;
  CgWork work_;
  Vector internal_;              // R(ω)
  double energy_ = 0.0;          // stored, at ω
  bool secant_current_ = false;  // the operator's g is that of ω
  std::vector<float> diagonal_;  // of the elastic B
  Vector volume_;                // lumped nodal volumes, for (15)
  Penalty penalty_;
  Penalty setup_penalty_;  // that the preconditioner was built with
  LinearProblem problem_;
  bool friction_ = false, linear_ = false;
  bool preconditioner_stale_ = true;
  double digits_per_cg_ = 0.0;           // right after the last setup
  std::vector<TraceChoice> pinned_set_;  // that the preconditioner was set up for
  bool newton_failed_ = false;           // the last semismooth step could not be solved
  LoopState loop_;
  std::uint64_t earlier_applications_ = 0;
  struct Kept {
    ContactState state;
    LoopState loop;
    Penalty penalty;
    bool newton_failed = false;
    Result result;
  };
  Kept kept_;            // after the last whole outer step; only where a run may be stopped
  double extent_ = 0.0;  // of the body
  double spectrum_seconds_ = 0.0, checkpoint_seconds_ = 0.0;
};

}  // namespace kacanov
