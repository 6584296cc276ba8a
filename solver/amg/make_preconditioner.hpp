// SPDX-License-Identifier: BSD-3-Clause
// Factory for the preconditioner selected in the options.
#pragma once

#include <memory>
#include <string>

#include <kacanov/model.hpp>
#include <kacanov/operator.hpp>
#include "linear/preconditioner.hpp"

namespace kacanov {

/// `multigrid`: geometric (octree) or aggregation multigrid with Chebyshev smoothing on the matrix-free
/// operator (Multigrid; theory: multigrid), with BoomerAMG below options.coarse_amg rows (theory:
/// coarse-amg). `elasticity`: unknown-based BoomerAMG on the assembled matrix, as a reference for comparison
/// (theory: elasticity-amg). Threads and instruction set are those of the operator. `like`: an operator with
/// the part's mesh and laws, whose blocks of elements the multigrid reuses, or null. Collective; the part
/// must outlive it.
std::unique_ptr<Preconditioner> make_preconditioner(const SolverOptions& options, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like = nullptr);

}  // namespace kacanov
