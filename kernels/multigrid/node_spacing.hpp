// SPDX-License-Identifier: BSD-3-Clause
// Node spacing of a body.
#pragma once

#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// Distance between neighbours around every local node, in the unit of the coordinates, from the volumes of
/// its elements and the number of nodes per element inside a body. `nodes`: index map of the nodes.
/// Collective.
std::vector<double> node_spacings(const Body& body, const IndexMap& nodes);

}  // namespace kacanov
