// SPDX-License-Identifier: BSD-3-Clause
// Adaptive mesh refinement of a case, driven by its error estimate.
#pragma once

#include <kacanov/run_options.hpp>
#include "case/case_file.hpp"
#include "program/coarse_run.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// With mesh.adapt: solves the case on its mesh, refines the elements with the largest estimated error
/// (theory: bisection), and solves again from there, until the error is small enough or a limit is reached.
/// On return input.mesh.adapted is the last mesh (on the first rank), a warning in `input` names the limit
/// that was reached, and the result is the initial solution of the run. Prints one line per mesh, except in a
/// host process. Throws InputError if the case does not fit its mesh. Collective.
CoarseRun adapt(Case& input, const MpiSession& mpi, const RunOptions& options);

}  // namespace kacanov
