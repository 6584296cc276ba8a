// SPDX-License-Identifier: BSD-3-Clause
// Setup of preconditioners: standing blocks and timing.
#include "linear/preconditioner.hpp"

#include <algorithm>

#include "linear/springs.hpp"

namespace kacanov {

namespace {

/// Relative to the largest diagonal entry of the node.
constexpr double pinned = 1e3;

std::vector<NodeBlock> pinning_blocks(const Part& part) {
  if (!part.node_map.any(!part.directions.empty())) return {};
  const std::size_t dim = part.dim();
  const Body body = part.body();
  std::vector<double> g(body.secant_count()), diagonal(part.unknowns());
  reference::secant(body, std::vector<double>(part.unknowns(), 0.0), g);
  reference::diagonal(body, g, diagonal);
  part.node_map.sum(diagonal, part.dim());
  std::vector<NodeBlock> blocks;
  for (const HeldDirection& held : part.directions) {
    if (held.node >= part.owned_nodes()) break;
    const double* d = &diagonal[held.node * dim];
    const double scale = pinned * *std::max_element(d, d + dim);
    NodeBlock block{held.node, {}};
    for (std::size_t r = 0; r < dim; ++r)
      for (std::size_t c = 0; c < dim; ++c)
        block.value[r * dim + c] = scale * held.direction[r] * held.direction[c];
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

std::vector<NodeBlock> Preconditioner::with_standing(const Part& part, std::span<const NodeBlock> blocks) {
  if (!pinned_) pins_ = pinning_blocks(part);
  pinned_ = true;
  std::vector<NodeBlock> all = with_springs(part, blocks);
  all.insert(all.end(), pins_.begin(), pins_.end());
  return all;
}

void Preconditioner::setup(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  build(g, with_standing(space.part(), blocks), space);
  seconds_ += MPI_Wtime() - start;
}

void Preconditioner::setup_again(std::span<const NodeBlock> blocks, const Space& space) {
  const double start = MPI_Wtime();
  rebuild(with_standing(space.part(), blocks), space);
  seconds_ += MPI_Wtime() - start;
}

}  // namespace kacanov
