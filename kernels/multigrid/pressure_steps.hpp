// SPDX-License-Identifier: BSD-3-Clause
// Pressures by Chebyshev iteration on the Schur complement, with one-sided error (theory:
// pressure-smoothing).
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "multigrid/chebyshev.hpp"
#include "operator/threads.hpp"

namespace kacanov {

/// A smoother takes steps with Â/ω, where ω are the weights of Chebyshev's polynomial on [Λ/range, Λ] and Λ
/// is the largest eigenvalue of D⁻¹A. A cycle takes them in one order on its way down and in reverse on its
/// way up.
struct SmootherWeights {
  double damping;              ///< Â = damping Λ D
  std::vector<double> weight;  ///< at least one
};

/// S belongs to the smallest weight, 1; for other weights it is ω (S − C) + C ≤ ω S. The smallest is first,
/// then the rest in descending order.
inline SmootherWeights chebyshev_weights(int steps, double range) {
  const double middle = (1.0 + 1.0 / range) / 2.0, half = (1.0 - 1.0 / range) / 2.0;
  const auto root = [&](int k) {  // in units of Λ, descending
    return middle + half * std::cos((2.0 * k + 1.0) * std::numbers::pi / (2.0 * steps));
  };
  SmootherWeights all{root(0), {1.0}};
  for (int k = steps - 1; k > 0; --k) all.weight.push_back(root(0) / root(k));
  return all;
}

/// Accuracy of solves with S: a polynomial of this degree in D⁻¹S on [Λ/range, Λ].
struct PressureSteps {
  int degree = 3;
  double range = 8.0;
};

/// P(S) ≈ S⁻¹ with P(S) ≤ S⁻¹, so that the inverse of P(S) is at least S and the smoother stays definite.
/// Single precision suffices because it acts on residuals.
class PressureSolve {
 public:
  double largest = 1.0;  ///< Λ, the largest eigenvalue of D⁻¹S

  /// `owned`: rows; vectors to be multiplied have `size` entries, with room for ghosts.
  void resize(std::size_t owned, std::size_t size) {
    residual_.resize(owned), step_.resize(owned), image_.resize(owned), x_.resize(size);
  }
  /// The residual, to be filled by the caller: one entry per row.
  std::span<float> residual() noexcept { return residual_; }

  /// Returns P(S) times the residual. `multiply(x, y)`: y = S x; `inverse`: D⁻¹. Collective if that is.
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
    // The polynomial's error oscillates between ±1/T(σ) on the interval.
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
