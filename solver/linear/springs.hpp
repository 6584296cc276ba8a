// SPDX-License-Identifier: BSD-3-Clause
// Springs to the ground as terms of the operator (theory: springs).
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/node_block.hpp"

namespace kacanov {

/// Returns the force of a spring on the body for this displacement of its node.
Vector3 spring_force(const NodeSpring& spring, const Part& part, std::span<const double> u);

/// y += K x at every copy of a node, for consistent vectors. Returns this rank's share of xᵀ K x.
double add_spring_response(const Part& part, std::span<const double> x, std::span<double> y);
/// Returns this rank's share of ½ uᵀ K u.
double spring_energy(const Part& part, std::span<const double> u);
/// d += the diagonal of K.
void add_spring_diagonal(const Part& part, std::span<double> d);
/// Returns `blocks` followed by those of the springs of owned nodes.
std::vector<NodeBlock> with_springs(const Part& part, std::span<const NodeBlock> blocks);

}  // namespace kacanov
