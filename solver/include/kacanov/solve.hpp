// SPDX-License-Identifier: BSD-3-Clause
// The solver's front door: a part of a problem in, a solution with its certificate out.
#pragma once

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include <kacanov/run_options.hpp>

namespace kacanov {

/// Solves the problem of which `part` is this rank's share (theory: kacanov, newton, active-set, admm).
/// - part: from distribute(), or joined. It is in units of its own while it is solved (theory: units), and as
/// it
///   was, to the bit, when solve() returns or throws; a const one is copied first. With the load steps of the
///   options the load grows in shares (theory: load-path).
/// - options, run: the same on every rank, but for what RunOptions says of rank 0.
/// Returns this rank's fields, in the numbering of the part, and the totals of all ranks in Solution::result.
/// Not converging is a status there, not an error: converged are solutions whose KKT residuals, by the
/// reference operator, are all within the tolerance (theory: kkt).
/// Throws InputError for options that validate() refuses, on all ranks alike, and InternalError where a
/// library beneath fails. Collective over the ranks of part.node_map.
Solution solve(Part& part, const SolverOptions& options, const RunOptions& run);
Solution solve(const Part& part, const SolverOptions& options, const RunOptions& run);

/// Extreme eigenvalues of the contact compliance K of the elastic body, and r* (theory: compliance, r-star,
/// lanczos), to options.spectrum_tolerance; no contact solve. One entry for N, a second for [N; T] where the
/// problem has friction, none without contact; each says whether it has converged. Throws as solve().
/// Collective.
std::vector<SpectrumResult> analyse_spectrum(Part& part, const SolverOptions& options, const RunOptions& run);
std::vector<SpectrumResult> analyse_spectrum(const Part& part, const SolverOptions& options,
                                             const RunOptions& run);

struct ActivePenalty {
  double r = 0.0;         ///< r_A; 0 where nothing touches
  bool converged = true;  ///< both estimates behind it, and their solves
};

/// r_A with g and contact set of a solution of this part (theory: r-active), to options.spectrum_tolerance.
/// Throws as solve(). Collective.
ActivePenalty active_penalty(Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run);
ActivePenalty active_penalty(const Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run);

}  // namespace kacanov
