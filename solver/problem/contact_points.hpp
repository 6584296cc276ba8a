// SPDX-License-Identifier: BSD-3-Clause
// From contact entries to contact points: normals, gaps, masses and the rows of N and T.
#pragma once

#include <kacanov/problem.hpp>
#include "problem/selection.hpp"

namespace kacanov {

/// Fills problem.contact, ascending by node; needs held and prescribed. The gap is that of the undeformed
/// node less what its prescribed components close, so that N·ω ≤ ρ holds with the free components in N alone.
void find_contact_points(Problem& problem, const Model& model, const Selection& selection);

}  // namespace kacanov
