// SPDX-License-Identifier: BSD-3-Clause
// Nested iteration: solves a case on coarser meshes first, each from the one before.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <kacanov/coarse_solution.hpp>
#include <kacanov/discretisation.hpp>
#include <kacanov/run_options.hpp>
#include "case/case_file.hpp"
#include "program/parallel.hpp"
#include "program/result_json.hpp"

namespace kacanov {

struct CoarseRun {
  std::vector<CoarseLevel> levels;        ///< coarsest first
  std::vector<CoarseSolution> solutions;  ///< one per load step, from the finest mesh that converged

  /// Adds the solution on one more mesh, and those at the ends of earlier load steps (`before`). `problem`:
  /// on the first rank. `halved`: the next mesh has the edges of this one halved. Collective.
  void take(const Solution& of, std::vector<CoarseSolution> before, const Part& part, const Problem* problem,
            double began, bool halved = false);
};

/// Returns one line for the output of a run.
std::string level_line(const CoarseLevel& level);
/// Returns options for a preliminary run: no reports and no checkpoints.
RunOptions silent(const RunOptions& options);
/// Returns whether any rank was asked to stop. Collective.
bool stop_wanted(const MpiSession& mpi, const RunOptions& options);
/// Solves to a tolerance of 1e-3, starting from earlier solutions. `step_over` as RunOptions::load_step_over.
/// Collective.
Solution solve_roughly(const Case& input, Part& part, RunOptions options, const CoarseRun& before,
                       std::function<void(const Part&, const Solution&)> step_over);

/// Solves the coarser meshes of a case one after the other to a tolerance of 1e-3: for a large enough box,
/// those with half the cells per axis; for a file with mesh.refine, those before each refinement; and those
/// named in mesh.files. A mesh that the case does not fit, or on which it does not converge, is skipped, as
/// it only provides an initial guess; for a named file a warning gives the reason. Returns no levels if
/// obstacles move or solver.nested is false.
/// - dim: dimension of the case's own mesh.
/// Prints one line per mesh, except in a host process. Throws InputError on all ranks for a named file that
/// is not a mesh. Collective.
CoarseRun solve_coarser(Case& input, std::size_t dim, const MpiSession& mpi, const RunOptions& options);

/// Fills result.discretisation: the energy error estimate, and the errors of probes and contact force from
/// the coarser meshes.
void note_discretisation(const DiscretisationError& error, const CoarseRun& coarse, Result& result);

}  // namespace kacanov
