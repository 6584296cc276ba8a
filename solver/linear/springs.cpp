// SPDX-License-Identifier: BSD-3-Clause
// Springs to the ground as terms of the operator.
#include "linear/springs.hpp"

namespace kacanov {

Vector3 spring_force(const NodeSpring& spring, const Part& part, std::span<const double> u) {
  const std::size_t dim = part.dim();
  Vector3 force{};
  for (std::size_t r = 0; r < dim; ++r)
    for (std::size_t c = 0; c < dim; ++c) force[r] -= spring.stiffness[r][c] * u[spring.node * dim + c];
  return force;
}

double add_spring_response(const Part& part, std::span<const double> x, std::span<double> y) {
  const std::size_t dim = part.dim();
  double share = 0.0;
  for (const NodeSpring& spring : part.springs) {
    const Vector3 force = spring_force(spring, part, x);
    for (std::size_t c = 0; c < dim; ++c) {
      const std::size_t i = spring.node * dim + c;
      y[i] -= force[c];
      if (spring.node < part.owned_nodes()) share -= force[c] * x[i];
    }
  }
  return share;
}

double spring_energy(const Part& part, std::span<const double> u) {
  const std::size_t dim = part.dim();
  double work = 0.0;
  for (const NodeSpring& spring : part.springs) {
    if (spring.node >= part.owned_nodes()) break;
    const Vector3 force = spring_force(spring, part, u);
    for (std::size_t c = 0; c < dim; ++c) work -= 0.5 * force[c] * u[spring.node * dim + c];
  }
  return work;
}

void add_spring_diagonal(const Part& part, std::span<double> d) {
  const std::size_t dim = part.dim();
  for (const NodeSpring& spring : part.springs)
    for (std::size_t c = 0; c < dim; ++c) d[spring.node * dim + c] += spring.stiffness[c][c];
}

std::vector<NodeBlock> with_springs(const Part& part, std::span<const NodeBlock> blocks) {
  std::vector<NodeBlock> all(blocks.begin(), blocks.end());
  const std::size_t dim = part.dim();
  for (const NodeSpring& spring : part.springs) {
    if (spring.node >= part.owned_nodes()) break;
    NodeBlock block{spring.node, {}};
    for (std::size_t r = 0; r < dim; ++r)
      for (std::size_t c = 0; c < dim; ++c) block.value[r * dim + c] = spring.stiffness[r][c];
    all.push_back(block);
  }
  return all;
}

}  // namespace kacanov
