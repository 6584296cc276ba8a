// SPDX-License-Identifier: BSD-3-Clause
// Materials, loads and given displacements: the entries of a model carried over to a mesh.
#pragma once

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Whether elements of this type are too stiff for the law without B-bar, and have that form.
bool locks_without_bbar(const Law& law, ElementType type);

/// Fills laws and law_of_element. An entry may overlap only an earlier entry on "all", which it overrides.
void assign_materials(Problem& problem, const Model& model, const Selection& selection);

/// Adds tractions, pressures and body forces to problem.load, which has nodes × dim entries. With load curves
/// fills steps and forces, and the load is that of the first step.
void assemble_load(Problem& problem, const Model& model, const Selection& selection);

/// Fills springs, those of facets lumped as contact is (theory: springs).
void add_springs(Problem& problem, const Model& model, const Selection& selection);

/// F of a point of the load curves.
std::vector<double> load_at(const Problem& problem, std::size_t step);

/// Fills held and prescribed. Two entries may hold one component of a node only at the same value.
void hold_displacements(Problem& problem, const Model& model, const Selection& selection);

}  // namespace kacanov
