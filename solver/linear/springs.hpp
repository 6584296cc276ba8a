// SPDX-License-Identifier: BSD-3-Clause
// Terms of the operator that follow from the conditions: free strains of a temperature, springs to the ground
// (theory: springs).
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/node_block.hpp"

namespace kacanov {

/// Of the elements of a body in plane stress, from the pressures that temperature takes off
/// (ThermalPressure), in the units of their laws (theory: expansion-in-plane).
std::vector<double> free_strain(const Body& body, std::span<const double> pressure);
/// The same of a part; empty but in plane stress, and where nothing is warmer.
std::vector<double> free_strain(const Part& part, std::span<const double> pressure);

struct ReferenceState {
  std::span<const double> u;
  std::span<const double> strain;             ///< free_strain(), or empty where all laws are linear
  std::span<const double> corner_dilatation;  ///< corner_dilatation() of u
};

/// R(u) + what the load has of temperature, and the energy whose slope that is, of this rank's elements
/// alone, by the reference operator.
double reference_response(const Part& part, const ReferenceState& state, std::span<double> internal);

/// What a spring does to the body at this displacement of its node.
Vector3 spring_force(const NodeSpring& spring, const Part& part, std::span<const double> u);

/// y += K x at every copy of a node, for vectors that are consistent. Returns this rank's share of xᵀ K x.
double add_spring_response(const Part& part, std::span<const double> x, std::span<double> y);
/// This rank's share of ½ uᵀ K u.
double spring_energy(const Part& part, std::span<const double> u);
/// d += the diagonal of K.
void add_spring_diagonal(const Part& part, std::span<double> d);
/// `blocks` and those of the springs of owned nodes.
std::vector<NodeBlock> with_springs(const Part& part, std::span<const NodeBlock> blocks);

}  // namespace kacanov
