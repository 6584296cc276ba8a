// SPDX-License-Identifier: BSD-3-Clause
// Nodes against obstacles: one producer of constraint rows.
#pragma once

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Fills problem.contact with narrow points, ascending by node; needs held and prescribed. The gap is that of
/// the undeformed node less what its prescribed components close, so that N·u ≤ ρ holds with the free
/// components in N alone.
void find_contact_points(Problem& problem, const Model& model, const Selection& selection);

}  // namespace kacanov
