// SPDX-License-Identifier: BSD-3-Clause
// Collects contact fields and totals of the whole body in a result: forces, extremes, counts.
#pragma once

#include <span>

#include <kacanov/element_fields.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>
#include "contact/admm.hpp"

namespace kacanov {

/// Fills gap, pressure, traction and status of this rank's contact points. A point whose slip exceeds ten
/// times the solve's `tolerance`, relative to the largest displacement, counts as slipping even if |λ_t| is
/// below its bound by rounding. Collective.
void collect_contact(const Part& part, const ContactState& state, double tolerance, Solution& solution);

/// Fills forces, counts, extremes and probes over all ranks from the contact fields and corner_dilatation of
/// `solution`. Collective.
void collect_totals(const Part& part, const ContactState& state, Solution& solution);

/// Fills extremes, plastic and softening elements, and the size of the undeformed body, over all ranks.
/// Collective.
void collect_body_totals(const Part& part, const BodyState& state, Result& result);

}  // namespace kacanov
