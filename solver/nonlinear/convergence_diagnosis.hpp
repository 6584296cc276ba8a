// SPDX-License-Identifier: BSD-3-Clause
// What of a state keeps it from converging, in words.
#pragma once

#include <string>

#include "nonlinear/outer_loop.hpp"

namespace kacanov {

/// The contact node that goes to and fro most, its place and how many others do; empty where none does.
/// `length`: the unit of the part's coordinates. Collective.
std::string who_cycles(const Part& part, const ContactChanges& changes, double length);

/// Who cycles, or that nobody does and which residual is left; what to try. From where the loop stands and
/// the steps that brought it there. Collective.
std::string diagnose_convergence(const OuterLoop& loop);

}  // namespace kacanov
