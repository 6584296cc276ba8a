// SPDX-License-Identifier: BSD-3-Clause
// The checks, one a file; each adds a sentence to the warnings where something looks mistaken.
#pragma once

#include <kacanov/validity.hpp>

namespace kacanov::validity {

using Warnings = std::vector<std::string>;

// Before the solve.

/// No load, no prescribed displacement, no obstacle that presses in.
void no_load(const Problem& problem, const Model& model, Warnings& warnings);
/// Young's modulus, yield stress and loads that lie orders apart.
void mixed_units(const Problem& problem, const Model& model, Warnings& warnings);
/// Facets of a contact entry whose outer normal points away from where the obstacle is.
void facet_orientation(const Problem& problem, const Model& model, Warnings& warnings);
/// Facets of a group that are not on the boundary of the body, and so have been left out.
void inner_facets(const Problem& problem, const Model& model, Warnings& warnings);
/// Elements thinner than a millionth of their length.
void thin_elements(const Problem& problem, Warnings& warnings);
/// Boundary nodes that lie at one place and are not one node: pieces that are not joined, and slits.
void unmerged_nodes(const Problem& problem, Warnings& warnings);
/// Boxes that cut through facets or elements, of which they take whole ones only.
void cut_selections(const Problem& problem, const Model& model, Warnings& warnings);
/// Coordinates so large beside elements that reading them has moved nodes.
void far_from_origin(const Problem& problem, Warnings& warnings);
/// Elements whose B-bar form was declined where they lock.
void locking(const Problem& problem, const Model& model, Warnings& warnings);

// After it.

/// Strains or rotations beyond what a theory of small strains is good for.
void large_strain(const Result& result, Warnings& warnings);
/// Linear tetrahedra far beyond yield, unless they are mixed.
void tet4_locking(const Result& result, const Model& model, Warnings& warnings);
/// Displacements that are not small beside the body.
void large_displacement(const Result& result, Warnings& warnings);
/// Contact entries that nothing presses on: lifted off, or never reached.
void inactive_contact(const Result& result, const Model& model, Warnings& warnings);
/// Contact entries that so few nodes press on that their pressure is no number.
void coarse_contact(const Result& result, const Model& model, Warnings& warnings);
/// Tresca's friction where nothing presses.
void open_friction(const Result& result, const Model& model, Warnings& warnings);

/// A few significant digits, for sentences.
std::string rounded(double value, int digits = 3);

}  // namespace kacanov::validity
