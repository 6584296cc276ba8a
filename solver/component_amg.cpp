// SPDX-License-Identifier: BSD-3-Clause
// A scalar BoomerAMG for each displacement component, with a coarse space of rigid motions.
#include "component_amg.hpp"

#include <algorithm>

namespace kacanov {

ComponentAmg::ComponentAmg(const Part& part)
    : part_(part),
      coarse_(part),
      right_(static_cast<std::size_t>(part.owned_nodes)),
      left_(static_cast<std::size_t>(part.owned_nodes)) {
  for (int c = 0; c < part.dim(); ++c)
    component_.push_back(
        std::make_unique<BoomerAmg>(part.halo.comm, part.first_owned, part.owned_nodes, part.total_nodes));
}

void ComponentAmg::build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  const auto dim = static_cast<std::size_t>(part_.dim());
  const NodeGraph graph = node_graph(part_.body().mesh);
  auto matrix = assemble_components(part_.body(), g, graph);
  for (const auto& b : blocks)
    for (std::size_t c = 0; c < dim; ++c) matrix[c][graph.position(b.node, b.node)] += b.value[c * dim + c];
  Vector diagonal(part_.unknowns());
  for (std::size_t n = 0; n < part_.nodes(); ++n)
    for (std::size_t c = 0; c < dim; ++c) {
      const auto node = static_cast<std::int32_t>(n);
      diagonal[n * dim + c] = matrix[c][graph.position(node, node)];
    }
  part_.halo.sum(diagonal, part_.dim());

  const auto owned = static_cast<std::size_t>(part_.owned_nodes);
  std::vector<HYPRE_Int> sizes(owned);
  for (std::size_t n = 0; n < owned; ++n) sizes[n] = static_cast<HYPRE_Int>(graph.row_size(n));
  std::vector<HYPRE_BigInt> columns;
  std::vector<double> values;
  for (std::size_t c = 0; c < dim; ++c) {
    component_[c]->begin(sizes);
    for (std::size_t n = 0; n < part_.nodes(); ++n) {
      columns.clear();
      values.clear();
      if (part_.held[n * dim + c]) {
        if (n >= owned) continue;
        columns.push_back(static_cast<HYPRE_BigInt>(part_.global_node[n]));
        values.push_back(diagonal[n * dim + c]);
      } else {
        for (auto k = static_cast<std::size_t>(graph.start[n]); k < static_cast<std::size_t>(graph.start[n + 1]); ++k) {
          const auto m = static_cast<std::size_t>(graph.column[k]);
          if (part_.held[m * dim + c]) continue;
          columns.push_back(static_cast<HYPRE_BigInt>(part_.global_node[m]));
          values.push_back(matrix[c][k]);
        }
      }
      component_[c]->add_row(static_cast<HYPRE_BigInt>(part_.global_node[n]), columns, values);
    }
    std::vector<double>().swap(matrix[c]);
    component_[c]->finish({1, part_.dim() == 3 ? 0.5 : 0.25, part_.dim() == 3 ? 1 : 0});
  }
  coarse_.build(g, blocks, space);
}

void ComponentAmg::apply(std::span<const double> r, std::span<double> z) {
  const auto dim = static_cast<std::size_t>(part_.dim());
  const auto owned = static_cast<std::size_t>(part_.owned_nodes);
  for (std::size_t c = 0; c < dim; ++c) {
    for (std::size_t n = 0; n < owned; ++n) right_[n] = r[n * dim + c];
    component_[c]->apply(right_.data(), left_.data());
    for (std::size_t n = 0; n < owned; ++n) z[n * dim + c] = left_[n];
  }
  coarse_.add(r, z);
  part_.halo.copy_from_owner(z, part_.dim());
}

}  // namespace kacanov
