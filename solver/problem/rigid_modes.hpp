// SPDX-License-Identifier: BSD-3-Clause
// Which rigid motions nothing holds, found before the solver meets them.
#pragma once

#include <kacanov/problem.hpp>

namespace kacanov {

/// For every connected piece of the mesh: throws InputError naming the rigid motions that neither
/// displacements nor contact hold; counts in problem.loose_modes those that the contact alone holds, with a
/// warning.
void check_rigid_modes(Problem& problem);

}  // namespace kacanov
