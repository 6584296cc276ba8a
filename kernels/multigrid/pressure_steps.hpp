// SPDX-License-Identifier: BSD-3-Clause
// Pressures by Chebyshev's iteration on the Schur complement, from one side (theory: pressure-smoothing).
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "multigrid/chebyshev.hpp"
#include "operator/threads.hpp"

namespace kacanov {

/// A smoother takes steps with Â/ω: the weights ω of Chebyshev's polynomial on [Λ/range, Λ], Λ the largest
/// eigenvalue of D⁻¹A. A cycle takes them in one order on its way down and in the other on its way back.
struct SmootherWeights {
  double damping;              ///< Â = this times Λ D
  std::vector<double> weight;  ///< 1 or more
};

/// S is that of the smallest weight, which is 1: others' is ω (S − C) + C ≤ ω S. It comes first, then the
/// rest falling.
inline SmootherWeights chebyshev_weights(int steps, double range) {
  const double middle = (1.0 + 1.0 / range) / 2.0, half = (1.0 - 1.0 / range) / 2.0;
  const auto root = [&](int k) {  // in units of Λ, falling
    return middle + half * std::cos((2.0 * k + 1.0) * std::numbers::pi / (2.0 * steps));
  };
  SmootherWeights all{root(0), {1.0}};
  for (int k = steps - 1; k > 0; --k) all.weight.push_back(root(0) / root(k));
  return all;
}

/// How well S is solved with: a polynomial of this degree in D⁻¹S on [Λ/range, Λ].
struct PressureSteps {
  int degree = 3;
  double range = 8.0;
};

/// P(S) ≈ S⁻¹, never above it: what it stands for is S or more, so that the smoother it is part of stays
/// definite. In single precision: what it works on is what is left of something.
class PressureSolve {
 public:
  double largest = 1.0;  ///< Λ, of D⁻¹S

  /// `owned` rows; vectors of `size` entries, with room for ghosts, are multiplied.
  void resize(std::size_t owned, std::size_t size) {
    residual_.resize(owned), step_.resize(owned), image_.resize(owned), x_.resize(size);
  }
  /// What is left, for the caller to fill: an entry a row.
  std::span<float> residual() noexcept { return residual_; }

  /// P(S) times what is left. `multiply(x, y)`: y = S x; `inverse`: D⁻¹. Collective where that is.
  template <class Multiply>
  std::span<const float> solve(const PressureSteps& steps, std::span<const float> inverse, int threads,
                               const Multiply& multiply) {
    const Chebyshev chebyshev{steps.degree, largest / steps.range, largest};
    const std::span<float> x = std::span(x_).first(residual_.size());
    chebyshev.smooth<float>(
        true, {residual_, x, step_, image_},
        [&](std::span<const float>, std::span<float> image) { multiply(std::span(x_), image); },
        [&](const ChebyshevStep<float>& weights, std::span<const float> b, std::span<const float> image,
            std::span<float> step, std::span<float> to) {
          weights.visit([&]<bool zero, bool no_step>() {
            each_in_shares(threads, b.size(), [&](std::size_t i) {
              weights.template take<zero, no_step>(inverse[i] * (zero ? b[i] : b[i] - image[i]), step[i],
                                                   to[i]);
            });
          });
        });
    // The polynomial's error swings between ±1/T(σ) on the interval.
    const double sigma = (steps.range + 1.0) / (steps.range - 1.0);
    const auto below = static_cast<float>(1.0 / (1.0 + 1.0 / std::cosh(steps.degree * std::acosh(sigma))));
    each_in_shares(threads, x.size(), [&](std::size_t i) { x[i] *= below; });
    return x;
  }

  std::size_t bytes() const noexcept {
    return (residual_.size() + x_.size() + step_.size() + image_.size()) * sizeof(float);
  }

 private:
  std::vector<float> residual_, x_, step_, image_;
};

}  // namespace kacanov
