// SPDX-License-Identifier: BSD-3-Clause
// Factory for the preconditioner selected in the options.
#pragma once

#include <memory>
#include <string>

#include <kacanov/model.hpp>
#include <kacanov/operator.hpp>
#include "linear/preconditioner.hpp"

namespace kacanov {

/// `multigrid`: octree or aggregation (theory: multigrid), BoomerAMG below options.coarse_amg rows (theory:
/// coarse-amg); `elasticity`: unknown-based BoomerAMG (theory: elasticity-amg); `cholesky`: a sparse
/// factor of the whole matrix on every rank (theory: factorised). `like`: operator with the
/// part's mesh and laws whose blocks multigrid reuses, or null. The part must outlive it. Collective.
std::unique_ptr<Preconditioner> make_preconditioner(const SolverOptions& options, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like = nullptr);

}  // namespace kacanov
