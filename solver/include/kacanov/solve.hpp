// SPDX-License-Identifier: BSD-3-Clause
// The solver's front door: a part of a problem in, a solution with its certificate out.
#pragma once

#include <functional>
#include <string>

#include <kacanov/checkpoint.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// One line of progress; sent on rank 0 only.
struct ProgressStep {
  std::string phase;  ///< "spectrum", "outer", "done", "note"
  std::string note;   ///< phase "note": a sentence for the user
  int outer = 0;
  std::int64_t contact_iterations = 0;  ///< of this outer step
  std::int64_t cg_iterations = 0;       ///< of this outer step
  double r = 0.0;
  double energy = 0.0;
  Certificate certificate;  ///< at the end of the step
  double seconds = 0.0;     ///< since the start of the run
};
using Progress = std::function<void(const ProgressStep&)>;

/// How to use the machine, as against what to solve.
struct RunOptions {
  int threads = 1;              ///< a rank
  std::string instruction_set;  ///< empty: the best there is
  Progress progress;            ///< may be empty

  /// Asked on every rank between operator applications; the first rank that says yes ends the run of all with
  /// the state after the last whole outer step and Status::interrupted. Empty: never.
  std::function<bool()> stop_requested;
  /// Called on rank 0 with what a later run needs to go on: after outer steps for which `checkpoint_due` says
  /// yes (empty: all; asked on rank 0), and at the end of a run that has not converged.
  std::function<void(const Checkpoint&)> checkpoint;
  std::function<bool()> checkpoint_due;
  /// Where to go on from; on rank 0, of the same problem.
  const Checkpoint* start = nullptr;
};

/// Solves the problem of which `part` is this rank's share. Collective over part.halo.comm. Not
/// converging is a status, not an error. Where there are load steps, the part is under a share of its load on
/// the way.
Solution solve(Part& part, const SolverOptions& options, const RunOptions& run);

/// Extreme eigenvalues of K for the elastic body, no contact solve. Collective. One entry for N, a
/// second for [N; T] where the problem has friction.
std::vector<SpectrumResult> analyse_spectrum(const Part& part, const SolverOptions& options,
                                             const RunOptions& run);

/// r_A = 1/√(λ_min(K_AA) λ_max(K_I|A)) with g and contact set of a solution: A what touches and sticks, I the
/// rest. 0 where nothing touches. Collective.
double active_penalty(const Part& part, const Solution& solution, const SolverOptions& options,
                      const RunOptions& run);

}  // namespace kacanov
