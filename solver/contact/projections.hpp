// SPDX-License-Identifier: BSD-3-Clause
// The pointwise steps of ADMM: projections onto the contact and friction laws (theory: projections).
#pragma once

#include <algorithm>
#include <cmath>

namespace kacanov {

/// φ_n and λ_n of one point, with w = ν·u (over-relaxed) and gap ρ.
struct NormalStep {
  double phi = 0.0, lambda = 0.0;
};
inline NormalStep normal_step(double w, double lambda, double gap, double r) {
  const double next = std::max(0.0, lambda + r * (w - gap));
  return {w + (lambda - next) / r, next};
}

/// φ_t and λ_t of one point with two tangential components and |λ_t| ≤ ψ (a disc).
struct TangentialStep {
  double phi[2] = {0.0, 0.0}, lambda[2] = {0.0, 0.0};
};
inline TangentialStep tangential_step(const double* w, const double* lambda, double bound, double r) {
  const double s[2] = {lambda[0] + r * w[0], lambda[1] + r * w[1]};
  const double length = std::hypot(s[0], s[1]);
  TangentialStep step;
  if (length <= bound) {  // stick
    step.lambda[0] = s[0];
    step.lambda[1] = s[1];
    return step;
  }
  for (int k = 0; k < 2; ++k) {
    step.lambda[k] = bound * (s[k] / length);
    step.phi[k] = (s[k] - step.lambda[k]) / r;
  }
  return step;
}

}  // namespace kacanov
