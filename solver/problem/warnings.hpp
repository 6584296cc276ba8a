// SPDX-License-Identifier: BSD-3-Clause
// Plausibility checks; each adds a sentence to the warnings if something looks mistaken.
#pragma once

#include <kacanov/validity.hpp>

namespace kacanov::validity {

using Warnings = std::vector<std::string>;

// Before the solve.

/// No load, no prescribed displacement and no obstacle that indents the body.
void no_load(const Problem& problem, const Model& model, Warnings& warnings);
/// Young's modulus, yield stress and loads that differ by implausible orders of magnitude.
void mixed_units(const Problem& problem, const Model& model, Warnings& warnings);
/// Facets of a contact entry whose outer normal points away from the obstacle.
void facet_orientation(const Problem& problem, const Model& model, Warnings& warnings);
/// Facets of a group that are not on the body's boundary and were therefore ignored.
void inner_facets(const Problem& problem, const Model& model, Warnings& warnings);
/// Elements thinner than a millionth of their length.
void thin_elements(const Problem& problem, Warnings& warnings);
/// Coincident boundary nodes that are not merged: unconnected pieces, and slits.
void unmerged_nodes(const Problem& problem, Warnings& warnings);
/// Selection boxes that cut through facets or elements; a box selects whole ones only.
void cut_selections(const Problem& problem, const Model& model, Warnings& warnings);
/// Coordinates so large relative to the elements that rounding them has moved nodes.
void far_from_origin(const Problem& problem, Warnings& warnings);
/// Elements that lock because their B-bar form was declined.
void locking(const Problem& problem, const Model& model, Warnings& warnings);

// After the solve.

/// Strains or rotations beyond the validity of small-strain theory.
void large_strain(const Result& result, Warnings& warnings);
/// Linear tetrahedra far beyond yield, unless they are mixed.
void tet4_locking(const Result& result, const Model& model, Warnings& warnings);
/// Displacements that are not small relative to the body.
void large_displacement(const Result& result, Warnings& warnings);
/// Contact entries without contact pressure: lifted off, or never reached.
void inactive_contact(const Result& result, const Model& model, Warnings& warnings);
/// Contact entries with too few nodes under pressure for a meaningful pressure.
void coarse_contact(const Result& result, const Model& model, Warnings& warnings);
/// Tresca friction at nodes without contact pressure.
void open_friction(const Result& result, const Model& model, Warnings& warnings);

/// Formats a value with a few significant digits for messages.
std::string rounded(double value, int digits = 3);

}  // namespace kacanov::validity
