// SPDX-License-Identifier: BSD-3-Clause
// Material laws of the second solver, from the formulas of the case file.
#pragma once

#include <kacanov/law.hpp>

namespace kacanov::testing {

/// g, dg/dx and ∫ g s ds of a law, from the formulas of the case file.
struct LawValues {
  double g, slope, energy;
};

/// At the strain x = ‖dev ε‖.
LawValues evaluate_law(const Law& law, double x);

}  // namespace kacanov::testing
