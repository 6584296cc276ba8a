// SPDX-License-Identifier: BSD-3-Clause
// The solver's entry points: each takes a part of a problem and returns a solution with its certificate; with
// moving obstacles, one solution after the other.
#pragma once

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include <kacanov/run_options.hpp>

namespace kacanov {

/// Solves the problem of which `part` is this rank's share (theory: kacanov, newton, active-set, admm).
/// - part: from distribute(), or joined. It is nondimensionalised while it is solved (theory: units), and
///   restored bit for bit when solve() returns or throws; a const part is copied first. With load steps in
///   the options, the load is applied in shares (theory: load-path).
/// - options, run: the same on every rank, except where RunOptions mentions rank 0.
/// Returns this rank's fields, in the numbering of the part; Solution::result holds the totals over all
/// ranks. Failure to converge is reported as a status, not thrown: a solution has converged if all its KKT
/// residuals, computed with the reference operator, are within the tolerance (theory: kkt).
/// Throws InputError on all ranks for options that validate() rejects, and InternalError if an underlying
/// library fails. Collective over the ranks of part.node_map.
Solution solve(Part& part, const SolverOptions& options, const RunOptions& run);
Solution solve(const Part& part, const SolverOptions& options, const RunOptions& run);

/// Computes the extreme eigenvalues of the contact compliance K of the elastic body, and r* (theory:
/// compliance, r-star, lanczos), to options.spectrum_tolerance, without a contact solve. Returns one entry
/// for N, a second one for [N; T] if the problem has friction, and none without contact; each entry has its
/// own convergence flag. Throws as solve(). Collective.
std::vector<SpectrumResult> analyse_spectrum(Part& part, const SolverOptions& options, const RunOptions& run);
std::vector<SpectrumResult> analyse_spectrum(const Part& part, const SolverOptions& options,
                                             const RunOptions& run);

struct ActivePenalty {
  double r = 0.0;         ///< r_A; 0 without active contact
  bool converged = true;  ///< both eigenvalue estimates, and their solves
};

/// Computes r_A for g and the contact set of a solution of this part (theory: r-active), to
/// options.spectrum_tolerance. Throws as solve(). Collective.
ActivePenalty active_penalty(Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run);
ActivePenalty active_penalty(const Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run);

/// Returns the model with its load steps converted to load curves, which solve_moving() needs; unchanged if
/// no obstacle moves.
Model with_curves(Model model);

/// Solves one load step after the other, each with solve() starting from the end of the previous one, with
/// the obstacles at their current positions (theory: moving-obstacles, force-control).
/// - part: of the problem that build_problem() creates from with_curves(model). Its contact rows and load
///   curves are left as in the last load step.
/// - model: the result of with_curves(); its obstacles' data are needed on rank 0 only.
/// - run: as for solve(); a checkpoint contains the current solve and the completed load steps.
/// Returns the same as solve(), with counts summed over all steps. Throws InputError on all ranks if an
/// obstacle leaves any node without a contact direction. Collective.
Solution solve_moving(Part& part, const Model& model, RunOptions run);

}  // namespace kacanov
