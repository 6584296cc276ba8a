// SPDX-License-Identifier: BSD-3-Clause
// Secant or tangent, and how long a step may be.
#include "nonlinear/linearisation.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

bool Linearisation::takes_tangent(double equilibrium) const {
  const bool far = outer_ == SolverOptions::Outer::automatic && (equilibrium > reach_ || cut_short_);
  return outer_ != SolverOptions::Outer::kacanov && !linear_ && !far;
}

void Linearisation::after_tangent(double before, double after, double length) {
  cut_short_ = length < tuning_.short_step;
  if (!(after <= before)) reach_ = std::max(tuning_.least_reach, tuning_.reach_cut * before);
}

std::optional<double> shorter_step(double t, double work, double curvature) {
  // Along δ the energy of the linear model falls with slope −q (1 − t). A step is too long where the true
  // force has grown past half of q more than the model says (unloading is stiffer than the tangent).
  if (!std::isfinite(work)) return t * 0.1;
  if (work <= 1.5 * curvature) return std::nullopt;
  return t * std::clamp(curvature / work, 0.1, 0.7);
}

}  // namespace kacanov
