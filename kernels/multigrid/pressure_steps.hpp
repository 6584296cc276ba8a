// SPDX-License-Identifier: BSD-3-Clause
// Pressures by Chebyshev's iteration on the Schur complement, from one side (theory: pressure-smoothing).
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "multigrid/chebyshev.hpp"

namespace kacanov {

/// Â = this times Λ D, Λ the largest eigenvalue of D⁻¹A: a smoother with less than a half would not be
/// definite, with all of it the cycle takes a quarter more iterations.
inline constexpr double pressure_damping = 0.65;

/// How well S is solved with: a polynomial of this degree in D⁻¹S on [Λ/range, Λ].
struct PressureSteps {
  int degree = 3;
  double range = 8.0;
};

/// p += P(S) (q − S p), P ≈ S⁻¹ and never above it: what it stands for is S or more, so that the smoother it
/// is part of stays definite.
class PressureSolve {
 public:
  double largest = 1.0;  ///< Λ, of D⁻¹S

  /// `multiply(x, y)`: y = S x, where x has `size` entries, which may be more than q has; `inverse`: D⁻¹.
  template <class Multiply>
  void improve(const PressureSteps& steps, std::span<const double> q, std::span<const double> inverse,
               std::span<double> p, const Multiply& multiply) {
    const std::size_t owned = q.size();
    for (auto* v : {&residual_, &correction_, &step_, &image_}) v->resize(p.size());
    multiply(p, std::span(image_));
    for (std::size_t i = 0; i < owned; ++i) residual_[i] = q[i] - image_[i];
    const Chebyshev chebyshev{steps.degree, largest / steps.range, largest};
    const auto first = [owned](std::vector<double>& v) { return std::span(v).first(owned); };
    chebyshev.smooth<double>(
        true, {first(residual_), first(correction_), first(step_), first(image_)},
        [&](std::span<const double>, std::span<double>) {
          multiply(std::span(correction_), std::span(image_));
        },
        [&](const ChebyshevStep<double>& weights, std::span<const double> b, std::span<const double> image,
            std::span<double> step, std::span<double> x) {
          weights.visit([&]<bool zero, bool no_step>() {
            for (std::size_t i = 0; i < owned; ++i)
              weights.template take<zero, no_step>(inverse[i] * (zero ? b[i] : b[i] - image[i]), step[i],
                                                   x[i]);
          });
        });
    // The polynomial's error swings between ±1/T(σ) on the interval.
    const double sigma = (steps.range + 1.0) / (steps.range - 1.0);
    const double below = 1.0 / (1.0 + 1.0 / std::cosh(steps.degree * std::acosh(sigma)));
    for (std::size_t i = 0; i < owned; ++i) p[i] += below * correction_[i];
  }

 private:
  std::vector<double> residual_, correction_, step_, image_;
};

}  // namespace kacanov
