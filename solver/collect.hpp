// SPDX-License-Identifier: BSD-3-Clause
// From the state of the loop to the fields and totals of a solution.
#pragma once

#include <kacanov/result.hpp>
#include "contact/admm.hpp"

namespace kacanov {

/// Gap, pressure, traction and status of this rank's contact points. A tangential displacement beyond ten
/// times the `tolerance` of the solve, relative to the largest displacement, is slip whatever rounding says
/// of the bound. Collective.
void collect_contact(const Part& part, const ContactState& state, double tolerance, Solution& solution);

/// Forces, counts, extremes and probes over all ranks; `solution` has its contact fields and its
/// corner_dilatation. Collective.
void collect_totals(const Part& part, const ContactState& state, Solution& solution);

}  // namespace kacanov
