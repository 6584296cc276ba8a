// SPDX-License-Identifier: BSD-3-Clause
// Material laws of the dense reference solver, from the formulas in the documentation of case files.
#pragma once

#include <kacanov/law.hpp>

namespace kacanov::testing {

/// g, dg/dx and ∫ g s ds of a law, from the formulas in the documentation of case files.
struct LawValues {
  double g, slope, energy;
};

/// Evaluates the law at the strain x = ‖dev ε‖.
LawValues evaluate_law(const Law& law, double x);

}  // namespace kacanov::testing
