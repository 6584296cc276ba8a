// SPDX-License-Identifier: BSD-3-Clause
// Generates constraint rows for nodes against obstacles.
#pragma once

#include <array>
#include <optional>

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Fills problem.contact with single-node points, ascending by node; needs held and prescribed. The gap is
/// that of the undeformed node minus the closure by prescribed components, so that N·u ≤ ρ holds with only
/// the free components in N.
void find_contact_points(Problem& problem, const Model& model, const Selection& selection);

/// The directions in which a node can move.
struct NodeFreedom {
  std::array<bool, 3> free{};                ///< free components
  std::span<const HeldDirection> held = {};  ///< other directions that are prescribed

  Vector3 project(Vector3 v) const {
    for (std::size_t c = 0; c < 3; ++c)
      if (!free[c]) v[c] = 0.0;
    return project_out(held, v);
  }
};

/// Returns the row of a node against an obstacle from the point's normal and the node's free directions; with
/// friction, fills the point's tangents. Empty if the node can hardly move along the normal.
std::optional<RowEntry> narrow_row(ContactPoint& point, const NodeFreedom& freedom, bool friction);

}  // namespace kacanov
