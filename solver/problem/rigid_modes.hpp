// SPDX-License-Identifier: BSD-3-Clause
// Which rigid motions nothing holds, found before the solver meets them.
#pragma once

#include <span>
#include <vector>

#include <kacanov/problem.hpp>

namespace kacanov {

/// For every connected piece of the mesh: throws InputError naming the rigid motions that neither
/// displacements nor contact hold; counts in problem.loose_modes those that the contact alone holds, with a
/// warning.
/// Where the loads of what contact alone holds can be in balance (theory: rigid-balance) it sets
/// problem.motions, else problem.no_equilibrium.
void check_rigid_modes(Problem& problem);

/// Displacements of these nodes by problem.motions (theory: rigid-start), nodes × dim; empty without any.
std::vector<double> rigid_start(const Problem& problem, std::span<const std::int32_t> nodes);

}  // namespace kacanov
