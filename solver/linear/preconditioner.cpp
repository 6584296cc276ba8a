// SPDX-License-Identifier: BSD-3-Clause
// The clock of a preconditioner's setups.
#include "linear/preconditioner.hpp"

#include "linear/springs.hpp"

namespace kacanov {

void Preconditioner::setup(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  build(g, with_springs(space.part(), blocks), space);
  seconds_ += MPI_Wtime() - start;
}

void Preconditioner::setup_again(std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  rebuild(with_springs(space.part(), blocks), space);
  seconds_ += MPI_Wtime() - start;
}

}  // namespace kacanov
