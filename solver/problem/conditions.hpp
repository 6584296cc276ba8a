// SPDX-License-Identifier: BSD-3-Clause
// Resolves materials, loads and prescribed displacements of a model on a mesh.
#pragma once

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Whether elements of this type lock for the law without B-bar, and have a B-bar form.
bool locks_without_bbar(const Law& law, ElementType type);

/// Fills laws and law_of_element. An entry may overlap only an earlier "all" entry, which it overrides.
void assign_materials(Problem& problem, const Model& model, const Selection& selection);

/// Adds tractions, pressures and body forces to problem.load (nodes × dim). With load curves it also fills
/// steps and forces, and the load is that of the first step.
void assemble_load(Problem& problem, const Model& model, const Selection& selection);

/// Fills springs. Springs on facets are lumped like the contact mass (theory: springs).
void add_springs(Problem& problem, const Model& model, const Selection& selection);

/// Returns the load vector F at a point of the load curves.
std::vector<double> load_at(const Problem& problem, std::size_t step);

/// Fills held and prescribed. Two entries may prescribe the same component of a node only with the same
/// value.
void hold_displacements(Problem& problem, const Model& model, const Selection& selection);

}  // namespace kacanov
