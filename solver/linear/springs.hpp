// SPDX-License-Identifier: BSD-3-Clause
// Springs to the ground as terms of the operator (theory: springs).
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// Returns the force of a spring on the body for this displacement of its node.
inline Vector3 spring_force(const NodeSpring& spring, const Part& part, std::span<const double> u) {
  const std::size_t dim = part.dim();
  Vector3 force{};
  for (std::size_t r = 0; r < dim; ++r)
    for (std::size_t c = 0; c < dim; ++c) force[r] -= spring.stiffness[r][c] * u[spring.node * dim + c];
  return force;
}

/// y += K x at every copy of a node, for consistent vectors. Returns this rank's share of xᵀ K x.
inline double add_spring_response(const Part& part, std::span<const double> x, std::span<double> y) {
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

/// Returns this rank's share of ½ uᵀ K u.
inline double spring_energy(const Part& part, std::span<const double> u) {
  const std::size_t dim = part.dim();
  double work = 0.0;
  for (const NodeSpring& spring : part.springs) {
    if (spring.node >= part.owned_nodes()) break;
    const Vector3 force = spring_force(spring, part, u);
    for (std::size_t c = 0; c < dim; ++c) work -= 0.5 * force[c] * u[spring.node * dim + c];
  }
  return work;
}

/// d += the diagonal of K.
inline void add_spring_diagonal(const Part& part, std::span<double> d) {
  const std::size_t dim = part.dim();
  for (const NodeSpring& spring : part.springs)
    for (std::size_t c = 0; c < dim; ++c) d[spring.node * dim + c] += spring.stiffness[c][c];
}

/// Returns `blocks` followed by those of the springs of owned nodes.
inline std::vector<NodeBlock> with_springs(const Part& part, std::span<const NodeBlock> blocks) {
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
