// SPDX-License-Identifier: BSD-3-Clause
// How far apart the nodes of a body are.
#pragma once

#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// The distance of neighbours round every local node, in the unit of the coordinates: by the volumes of the
/// elements there and of how many nodes such elements have in a body they fill. `nodes`: their map.
/// Collective.
std::vector<double> node_spacings(const Body& body, const IndexMap& nodes);

}  // namespace kacanov
