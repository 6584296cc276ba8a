// SPDX-License-Identifier: BSD-3-Clause
// Refinement of some elements of a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Whether bisect() cuts elements of this type: simplices.
bool can_bisect(ElementType type);
/// Throws InputError for one that it does not.
void refuse_to_bisect(ElementType type);

/// Halves every edge of the `marked` elements (indices), and of their neighbours what keeps the mesh
/// conforming and their shapes good (theory: bisection). Nodes keep their numbers and tags, new ones follow,
/// but for those in the middle of edges with curves, which become corners. Groups become those of the
/// children; element numbers of a file are lost. Throws InputError where nodes no longer fit 32-bit indices.
Mesh bisect(const Mesh& mesh, std::span<const std::int32_t> marked);

/// The fewest elements that have `share` of the sum of `energy`, one number ≥ 0 an element, as of
/// DiscretisationError (theory: bisection).
std::vector<std::int32_t> worst_elements(std::span<const double> energy, double share);

}  // namespace kacanov
