// SPDX-License-Identifier: BSD-3-Clause
// Operator terms that follow from conditions: free thermal strains and springs to the ground (theory:
// springs).
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/node_block.hpp"

namespace kacanov {

/// Returns the free strains of the elements of a body in plane stress, from its thermal pressures
/// (ThermalPressure), in the units of their laws (theory: expansion-in-plane).
std::vector<double> free_strain(const Body& body, std::span<const double> pressure);
/// The same for a part; empty except in plane stress with a temperature.
std::vector<double> free_strain(const Part& part, std::span<const double> pressure);

struct ReferenceState {
  std::span<const double> u;
  std::span<const double> strain;             ///< free_strain(), or empty if all laws are linear
  std::span<const double> corner_dilatation;  ///< corner_dilatation() of u
};

/// Computes R(u) plus the thermal part of the load in `internal`, and returns the energy whose gradient that
/// is, for this rank's elements only, with the reference operator.
double reference_response(const Part& part, const ReferenceState& state, std::span<double> internal);

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
