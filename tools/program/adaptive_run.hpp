// SPDX-License-Identifier: BSD-3-Clause
// Refines the mesh of a case where its solution asks for it.
#pragma once

#include <kacanov/run_options.hpp>
#include "case/case_file.hpp"
#include "program/coarse_run.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// With mesh.adapt: solves the case on its mesh, refines that where the estimated error is (theory:
/// bisection), solves again from there, and so on, until the error is small enough or a limit is met. Then
/// input.mesh.adapted is the last mesh, on the first rank, with a warning in `input` of a limit that was met,
/// and the solution on it is what the run starts from. Prints a line a mesh, but in a host's process. Throws
/// InputError where the case does not fit its mesh. Collective.
CoarseRun adapt(Case& input, const MpiSession& mpi, const RunOptions& options);

}  // namespace kacanov
