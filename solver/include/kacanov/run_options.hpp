// SPDX-License-Identifier: BSD-3-Clause
// Execution options of a run: threads, instruction set, callbacks, checkpoints and initial guesses.
#pragma once

#include <functional>
#include <span>
#include <string>

#include <kacanov/checkpoint.hpp>
#include <kacanov/coarse_solution.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// One line of progress; reported on rank 0 only.
struct ProgressStep {
  std::string phase;  ///< algorithm of the step: "admm", "dual_admm", "active_set" or "newton"
  int outer = 0;      ///< outer steps so far, including those before a restart
  std::int64_t contact_iterations = 0;  ///< of this outer step
  std::int64_t cg_iterations = 0;       ///< of this outer step
  double r = 0.0;                       ///< penalty of N
  double energy = 0.0;                  ///< stored in the body
  Certificate certificate;              ///< at the end of the step
  double seconds = 0.0;                 ///< since the start of the run
};
using Progress = std::function<void(const ProgressStep&)>;

/// How to execute a run, as opposed to what to solve.
struct RunOptions {
  int threads = 1;              ///< per rank
  std::string instruction_set;  ///< empty: the best available
  Progress progress;            ///< called on rank 0 after every outer step; may be empty
  /// Called on rank 0 when a phase begins, with a short description: "setting the solver up"; may be empty.
  std::function<void(const std::string&)> phase;

  /// Called on rank 0 at the beginning of each of several load steps, and whenever a force-controlled
  /// obstacle is moved: "load step 2 of 4 (factor 0.5)"; may be empty.
  std::function<void(const std::string&)> stage;

  /// Called on every rank every few operator applications; must not communicate. Once it returns true on any
  /// rank, all ranks stop with the state after the last completed outer step and Status::interrupted. Empty:
  /// never.
  std::function<bool()> stop_requested;
  /// Called on rank 0 with the checkpoint from which a later run can continue: after each outer step for
  /// which `checkpoint_due` returns true (empty: all; called on rank 0), and at the end of a run that has not
  /// converged.
  std::function<void(const Checkpoint&)> checkpoint;
  std::function<bool()> checkpoint_due;
  /// Checkpoint of the same problem to continue from; on rank 0.
  const Checkpoint* start = nullptr;
  /// Solutions on a coarser mesh as initial guess, the same on every rank; `start` takes precedence. Either
  /// one, for the beginning, or one per load step (theory: nested).
  std::span<const CoarseSolution> coarse = {};
  /// Called on all ranks with the converged end of every load step but the last. The part is in the user's
  /// units at that time, and the result has one line per completed load step. Empty: never.
  std::function<void(const Part&, const Solution&)> load_step_over;
  /// Initial values on this rank's part, in the user's units (null: start from rest); on all ranks or none.
  const Start* from = nullptr;
};

}  // namespace kacanov
