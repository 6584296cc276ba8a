// SPDX-License-Identifier: BSD-3-Clause
// Node patches over which linear tetrahedra average their volume change.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// Computes Body::pressure_patch for a body of tet4, or for this rank's part of one. A patch holds the nodes
/// in one octree cube, whose edge is about 2.6 node spacings, that are connected by elements within the cube
/// (theory: pressure-patches). Apart from rounding of coordinates, the patches depend on node positions only,
/// not on numbering or ownership. Empty where no law averages, and for other element types. `nodes`: index
/// map of the nodes. Collective.
std::vector<std::int64_t> pressure_patches(const Body& body, const IndexMap& nodes);

}  // namespace kacanov
