// SPDX-License-Identifier: BSD-3-Clause
// Solves a case on coarser meshes first, each from the one before.
#pragma once

#include <optional>
#include <vector>

#include <kacanov/coarse_solution.hpp>
#include <kacanov/run_options.hpp>
#include "case/case_file.hpp"
#include "program/parallel.hpp"
#include "program/result_json.hpp"

namespace kacanov {

struct CoarseRun {
  std::vector<CoarseLevel> levels;         ///< coarsest first
  std::optional<CoarseSolution> solution;  ///< of the finest of them that has converged
};

/// The coarser meshes of a case, one after the other, to a thousandth: of a large enough box those with half
/// the cells, of a file that is refined those before. One that the case does not fit, or that does not
/// converge, is passed over: it is only to start from. None with load steps, or where solver.nested says so.
/// Prints a line a mesh, but in a host's process. Collective.
CoarseRun solve_coarser(const Case& input, const MpiSession& mpi, const RunOptions& options);

}  // namespace kacanov
