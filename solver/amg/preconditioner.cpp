// SPDX-License-Identifier: BSD-3-Clause
// The choice of a preconditioner, and the clock of its setups.
#include "linear/preconditioner.hpp"

#include "amg/elasticity_amg.hpp"
#include "amg/rigid_multigrid.hpp"

namespace kacanov {

void Preconditioner::setup(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  build(g, blocks, space);
  ++setups_;
  seconds_ += MPI_Wtime() - start;
}

void Preconditioner::setup_again(std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  rebuild(blocks, space);
  ++setups_;
  seconds_ += MPI_Wtime() - start;
}

std::unique_ptr<Preconditioner> make_preconditioner(SolverOptions::Preconditioner kind, const Part& part,
                                                    int threads, const std::string& instruction_set) {
  if (kind == SolverOptions::Preconditioner::elasticity) return std::make_unique<ElasticityAmg>(part);
  MultigridOptions options;
  options.threads = threads;
  options.instruction_set = instruction_set;
  return std::make_unique<RigidMultigrid>(part, options);
}

}  // namespace kacanov
