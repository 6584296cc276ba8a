// SPDX-License-Identifier: BSD-3-Clause
// From the units of a part to its user's: everything that has a unit in what a run reports.
#pragma once

#include <kacanov/coarse_solution.hpp>
#include <kacanov/result.hpp>
#include "parallel/unit_system.hpp"

namespace kacanov {

/// Multiplies by the units. Load steps in a result are left alone: each is in the user's units from its end
/// on.
void to_users_units(Solution& solution, const UnitSystem& units);
void to_users_units(LoadStep& step, const UnitSystem& units);
void to_users_units(SpectrumResult& spectrum, const UnitSystem& units);

/// The other way: what a run starts from.
void to_own_units(Start& start, const UnitSystem& units);

}  // namespace kacanov
