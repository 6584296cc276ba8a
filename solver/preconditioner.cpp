// SPDX-License-Identifier: BSD-3-Clause
// The choice of a preconditioner, and the clock of its setups.
#include "preconditioner.hpp"

#include "component_amg.hpp"
#include "elasticity_amg.hpp"

namespace kacanov {

void Preconditioner::setup(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  build(g, blocks, space);
  ++setups_;
  seconds_ += MPI_Wtime() - start;
}

std::unique_ptr<Preconditioner> make_preconditioner(SolverOptions::Preconditioner kind, const Part& part) {
  if (kind == SolverOptions::Preconditioner::elasticity) return std::make_unique<ElasticityAmg>(part);
  return std::make_unique<ComponentAmg>(part);
}

}  // namespace kacanov
