// SPDX-License-Identifier: BSD-3-Clause
// From the units of a part to its user's: everything that has a unit in what a run reports.
#pragma once

#include <kacanov/coarse_solution.hpp>
#include <kacanov/result.hpp>
#include "parallel/units.hpp"

namespace kacanov {

/// Multiplies by the units. Load steps in a result are left alone: each is in the user's units from its end
/// on.
void to_users_units(Solution& solution, const Units& units);
void to_users_units(LoadStep& step, const Units& units);
void to_users_units(SpectrumResult& spectrum, const Units& units);

/// The other way: what a run starts from.
void to_own_units(Start& start, const Units& units);

}  // namespace kacanov
