// SPDX-License-Identifier: BSD-3-Clause
// A step of the method of multipliers: the augmented Lagrangian minimised over the displacement.
#pragma once

#include "nonlinear/augmented_control.hpp"
#include "nonlinear/step.hpp"

namespace kacanov {

/// Minimises stored energy, load and what contact adds at the multipliers and bounds of the state
/// (theory: augmented-newton), by semismooth Newton steps with a line search: each lowers it, wherever it
/// starts. The multipliers move on at the end. R(u) and the secant have to be those of the state, and are
/// afterwards. Collective.
StepOutcome augmented_step(StepContext& c, AugmentedControl& control, const Residuals& before);

}  // namespace kacanov
