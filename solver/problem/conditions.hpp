// SPDX-License-Identifier: BSD-3-Clause
// Materials, loads and given displacements: the entries of a model carried over to a mesh.
#pragma once

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Fills laws and law_of_element. An entry may overlap only an earlier entry on "all", which it overrides.
void assign_materials(Problem& problem, const Model& model, const Selection& selection);

/// Adds tractions, pressures and body forces to problem.load, which has nodes × dim entries.
void assemble_load(Problem& problem, const Model& model, const Selection& selection);

/// Fills held and prescribed. Two entries may hold one component of a node only at the same value.
void hold_displacements(Problem& problem, const Model& model, const Selection& selection);

}  // namespace kacanov
