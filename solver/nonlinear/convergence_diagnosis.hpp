// SPDX-License-Identifier: BSD-3-Clause
// Explains why a run did not converge.
#pragma once

#include <string>

#include "nonlinear/outer_loop.hpp"

namespace kacanov {

/// Describes the contact node that oscillates most, its position, and the number of other oscillating nodes;
/// empty if there are none. `length`: unit of the part's coordinates. Collective.
std::string who_cycles(const Part& part, const ContactChanges& changes, double length);

/// Describes oscillating contact nodes, or else the largest residual, and suggests a remedy, from the loop's
/// state and its last steps. Collective.
std::string diagnose_convergence(const OuterLoop& loop);

}  // namespace kacanov
