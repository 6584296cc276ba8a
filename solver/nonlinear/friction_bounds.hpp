// SPDX-License-Identifier: BSD-3-Clause
// The friction bound ψ of every contact point.
#pragma once

#include "contact/traces.hpp"

namespace kacanov {

/// Whether any point on any rank has friction. Collective.
bool has_friction(const Part& part);

/// Whether any point on any rank measures slip from the previous load step. Collective.
bool has_slip_history(const Part& part);

/// Sets ψ = Tresca bound + μ_f λ_n for all points of this rank (theory: coulomb). Returns the largest change
/// of `bound` over all ranks, relative to the largest pressure; 0 without pressure. Collective.
double follow_pressure(const Part& part, const Vector& pressure, Vector& bound);

}  // namespace kacanov
