// SPDX-License-Identifier: BSD-3-Clause
// The solver's front door: a part of a problem in, a solution with its certificate out.
#pragma once

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include <kacanov/run_options.hpp>

namespace kacanov {

/// Solves the problem of which `part` is this rank's share. Collective over part.halo.comm. Not
/// converging is a status, not an error.
Solution solve(const Part& part, const SolverOptions& options, const RunOptions& run);

/// Extreme eigenvalues of K for the elastic body, no contact solve. Collective. One entry for N, a
/// second for [N; T] where the problem has friction.
std::vector<SpectrumResult> analyse_spectrum(const Part& part, const SolverOptions& options,
                                             const RunOptions& run);

struct ActivePenalty {
  double r = 0.0;         ///< r_A; 0 where nothing touches
  bool converged = true;  ///< both estimates behind it, and their solves
};

/// r_A with g and contact set of a solution (theory: r-active). Collective.
ActivePenalty active_penalty(const Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run);

}  // namespace kacanov
