// SPDX-License-Identifier: BSD-3-Clause
// Refinement of marked elements by bisection.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Whether bisect() supports elements of this type: simplices only.
bool can_bisect(ElementType type);
/// Throws InputError if bisect() does not support this type.
void refuse_to_bisect(ElementType type);

/// Halves every edge of the `marked` elements (indices), and splits neighbours as far as needed to keep the
/// mesh conforming and well shaped (theory: bisection). Nodes keep their numbers and tags, and new nodes
/// follow, except that mid-side nodes of curved edges become corners. Groups then contain the children;
/// element numbers of the mesh file are lost. Throws InputError if the number of nodes exceeds 32-bit
/// indices.
Mesh bisect(const Mesh& mesh, std::span<const std::int32_t> marked);

/// Returns the smallest set of elements that holds `share` of the sum of `energy`, one number ≥ 0 per
/// element, as in DiscretisationError (theory: bisection).
std::vector<std::int32_t> worst_elements(std::span<const double> energy, double share);

}  // namespace kacanov
