// SPDX-License-Identifier: BSD-3-Clause
// The choice of a preconditioner.
#include "amg/make_preconditioner.hpp"

#include "amg/elasticity_amg.hpp"
#include "amg/part_multigrid.hpp"

namespace kacanov {

std::unique_ptr<Preconditioner> make_preconditioner(SolverOptions::Preconditioner kind, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like) {
  if (kind == SolverOptions::Preconditioner::elasticity) return std::make_unique<ElasticityAmg>(part);
  MultigridOptions options;
  options.threads = threads;
  options.instruction_set = instruction_set;
  return std::make_unique<PartMultigrid>(part, options, like);
}

}  // namespace kacanov
