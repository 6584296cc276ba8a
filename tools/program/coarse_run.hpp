// SPDX-License-Identifier: BSD-3-Clause
// Solves a case on coarser meshes first, each from the one before.
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
  std::vector<CoarseSolution> solutions;  ///< of the finest of them that has converged, one a load step

  /// Takes up what has come out on one more mesh, with the ends of the load steps before the last. `problem`:
  /// on the first rank. Collective. `halved`: whether the next mesh has its edges halved.
  void take(const Solution& of, std::vector<CoarseSolution> before, const Part& part, const Problem* problem,
            double began, bool halved = false);
};

/// One line for people.
std::string level_line(const CoarseLevel& level);
/// For runs before the run: nothing is reported or saved.
RunOptions silent(const RunOptions& options);
/// Whether any rank has been asked to stop. Collective.
bool stop_wanted(const MpiSession& mpi, const RunOptions& options);
/// To a thousandth, from the solutions before. `step_over` as RunOptions::load_step_over. Collective.
Solution solve_roughly(const Case& input, Part& part, RunOptions options, const CoarseRun& before,
                       std::function<void(const Part&, const Solution&)> step_over);

/// The coarser meshes of a case, one after the other, to a thousandth: of a large enough box those with half
/// the cells, of a file that is refined those before, and those that mesh.files names. One that the case does
/// not fit, or that does not converge, is passed over: it is only to start from; of a file that was named, a
/// warning of the case says why. None where obstacles move, or where solver.nested says so.
/// - dim: of the case's own mesh.
/// Prints a line a mesh, but in a host's process. Throws InputError for a named file that is no mesh, on all
/// ranks alike. Collective.
CoarseRun solve_coarser(Case& input, std::size_t dim, const MpiSession& mpi, const RunOptions& options);

/// Fills in result.discretisation: the estimate of the strains, and what the coarser meshes tell of probes
/// and the contact force.
void note_discretisation(const DiscretisationError& error, const CoarseRun& coarse, Result& result);

}  // namespace kacanov
