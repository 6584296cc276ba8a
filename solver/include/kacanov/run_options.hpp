// SPDX-License-Identifier: BSD-3-Clause
// How a run is to use the machine, and whom it tells and asks on the way.
#pragma once

#include <functional>
#include <span>
#include <string>

#include <kacanov/checkpoint.hpp>
#include <kacanov/coarse_solution.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// One line of progress; sent on rank 0 only.
struct ProgressStep {
  std::string phase;  ///< how the step was taken: "admm", "dual_admm", "active_set" or "newton"
  int outer = 0;      ///< outer steps so far, those before a restart included
  std::int64_t contact_iterations = 0;  ///< of this outer step
  std::int64_t cg_iterations = 0;       ///< of this outer step
  double r = 0.0;                       ///< penalty of N
  double energy = 0.0;                  ///< stored in the body
  Certificate certificate;              ///< at the end of the step
  double seconds = 0.0;                 ///< since the start of the run
};
using Progress = std::function<void(const ProgressStep&)>;

/// How to use the machine, as against what to solve.
struct RunOptions {
  int threads = 1;              ///< a rank
  std::string instruction_set;  ///< empty: the best there is
  Progress progress;            ///< called on rank 0 after every outer step; may be empty
  /// Called on rank 0 with what begins now, in a few words: "setting the solver up"; may be empty.
  std::function<void(const std::string&)> phase;

  /// Called on rank 0 where one of several load steps begins, and where an obstacle is pushed to: "load step
  /// 2 of 4 (factor 0.5)"; may be empty.
  std::function<void(const std::string&)> stage;

  /// Asked on every rank every few operator applications (it must not communicate); the first rank that says
  /// yes ends the run of all with the state after the last whole outer step and Status::interrupted. Empty:
  /// never.
  std::function<bool()> stop_requested;
  /// Called on rank 0 with what a later run needs to go on: after outer steps for which `checkpoint_due` says
  /// yes (empty: all; asked on rank 0), and at the end of a run that has not converged.
  std::function<void(const Checkpoint&)> checkpoint;
  std::function<bool()> checkpoint_due;
  /// Where to go on from; on rank 0, of the same problem.
  const Checkpoint* start = nullptr;
  /// The same body solved on a coarser mesh, to start from; the same on every rank. `start` goes before it.
  /// One to begin with, or one of every load step, which then begins with its own (theory: nested).
  std::span<const CoarseSolution> coarse = {};
  /// Called on all ranks with the end of every load step that has converged but the last one; the part is
  /// in the user's units then, the result has the lines of the load steps so far. Empty: never.
  std::function<void(const Part&, const Solution&)> load_step_over;
  /// Begins from these values of this rank's part, in the user's units (null: from rest); on all ranks or
  /// none.
  const Start* from = nullptr;
};

}  // namespace kacanov
