// SPDX-License-Identifier: BSD-3-Clause
// The choice of a preconditioner.
#pragma once

#include <memory>
#include <string>

#include <kacanov/model.hpp>
#include <kacanov/operator.hpp>
#include "linear/preconditioner.hpp"

namespace kacanov {

/// `multigrid`: Chebyshev on the matrix-free operator over grids or aggregates (Multigrid; theory:
/// multigrid), with BoomerAMG from options.coarse_amg rows down (theory: coarse-amg). `elasticity`:
/// unknown-based BoomerAMG on the assembled matrix, the yardstick (theory: elasticity-amg). Threads and
/// instruction set are the operator's. `like`: an operator of the part's mesh and laws, whose division of the
/// elements the multigrid takes over, or null. Collective; the part has to outlive it.
std::unique_ptr<Preconditioner> make_preconditioner(const SolverOptions& options, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like = nullptr);

}  // namespace kacanov
