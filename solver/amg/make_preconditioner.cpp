// SPDX-License-Identifier: BSD-3-Clause
// Factory for the preconditioner selected in the options.
#include "amg/make_preconditioner.hpp"

#include "amg/boomer_amg.hpp"
#include "amg/coarse_amg.hpp"
#include "amg/factorised.hpp"
#include "amg/part_multigrid.hpp"

namespace kacanov {

std::unique_ptr<Preconditioner> make_preconditioner(const SolverOptions& options, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like) {
  if (options.preconditioner == SolverOptions::Preconditioner::elasticity)
    return std::make_unique<ElasticityAmg>(part);
  if (options.preconditioner == SolverOptions::Preconditioner::cholesky)
    return std::make_unique<Factorised>(part);
  MultigridOptions multigrid;
  multigrid.threads = threads;
  multigrid.instruction_set = instruction_set;
  multigrid.coarse_rows = options.coarse_amg;
  multigrid.make_coarse = make_coarse_amg;
  return std::make_unique<PartMultigrid>(part, multigrid, like);
}

}  // namespace kacanov
