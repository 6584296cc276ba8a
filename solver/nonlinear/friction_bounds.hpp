// SPDX-License-Identifier: BSD-3-Clause
// The friction bound ψ of every contact point.
#pragma once

#include "contact/traces.hpp"

namespace kacanov {

/// Whether some point of some rank may slide with friction. Collective.
bool has_friction(const Part& part);

/// Whether slip of some point of some rank is counted from the load step before. Collective.
bool has_slip_history(const Part& part);

/// ψ = Tresca's bound + μ_f λ_n for all points of this rank (theory: coulomb). Returns the largest change of
/// `bound` over all ranks, relative to the largest pressure; 0 without pressure. Collective.
double follow_pressure(const Part& part, const Vector& pressure, Vector& bound);

}  // namespace kacanov
