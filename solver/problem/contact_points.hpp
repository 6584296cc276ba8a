// SPDX-License-Identifier: BSD-3-Clause
// Nodes against obstacles: one producer of constraint rows.
#pragma once

#include <array>
#include <optional>

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Fills problem.contact with narrow points, ascending by node; needs held and prescribed. The gap is that of
/// the undeformed node less what its prescribed components close, so that N·u ≤ ρ holds with the free
/// components in N alone.
void find_contact_points(Problem& problem, const Model& model, const Selection& selection);

/// Where a node can move.
struct NodeFreedom {
  std::array<bool, 3> free{};                ///< components
  std::span<const HeldDirection> held = {};  ///< directions besides

  Vector3 project(Vector3 v) const {
    for (std::size_t c = 0; c < 3; ++c)
      if (!free[c]) v[c] = 0.0;
    return project_out(held, v);
  }
};

/// The row of a node against an obstacle, by the point's normal and where the node can move; fills the
/// point's tangents where there is friction. Nothing where the node can hardly move along the normal.
std::optional<RowEntry> narrow_row(ContactPoint& point, const NodeFreedom& freedom, bool friction);

}  // namespace kacanov
