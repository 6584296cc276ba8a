// SPDX-License-Identifier: BSD-3-Clause
// What a result has of the contact and of the whole body: forces, extremes, counts.
#pragma once

#include <span>

#include <kacanov/element_fields.hpp>
#include <kacanov/part.hpp>
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

/// Extremes, plastic and softening elements, and the undeformed body, over all ranks. Collective.
void collect_body_totals(const Part& part, const BodyState& state, Result& result);

}  // namespace kacanov
