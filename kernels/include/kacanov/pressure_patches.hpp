// SPDX-License-Identifier: BSD-3-Clause
// The patches of nodes over which linear tetrahedra average their volume change.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// Body::pressure_patch of a body of tet4, or of this rank's part of one: nodes that lie in one cube of a
/// tree some 2.6 of their distances wide, and hang together by elements within it (theory: pressure-patches).
/// It depends on where nodes are, not on their numbers or on who has them, but for rounding of coordinates.
/// Empty where no law averages, and for other elements. `nodes`: their map. Collective.
std::vector<std::int64_t> pressure_patches(const Body& body, const IndexMap& nodes);

}  // namespace kacanov
