// SPDX-License-Identifier: BSD-3-Clause
// Chebyshev smoothing with any products by A and D⁻¹.
#pragma once

#include <cstddef>
#include <span>

namespace kacanov {

/// One step of the smoother, row by row: step = keep · step + add · D⁻¹(b − A x), x += step.
template <class S>
struct ChebyshevStep {
  S keep, add;
  bool from_zero;  ///< x, and with it A x, counts as zero; `step` and x may then be the same vector
  bool first;      ///< `step` counts as zero

  /// Calls loop<from_zero, first>().
  template <class Loop>
  void visit(const Loop& loop) const {
    if (from_zero)
      loop.template operator()<true, true>();
    else if (first)
      loop.template operator()<false, true>();
    else
      loop.template operator()<false, false>();
  }
  /// Updates an entry of `step` and x; `scaled`: its entry of D⁻¹(b − A x).
  template <bool zero, bool no_step>
  void take(S scaled, S& step, S& x) const {
    step = no_step ? add * scaled : keep * step + add * scaled;
    x = zero ? step : x + step;
  }
};

/// The vectors of a smoother, of equal length: input b, iterate x, and scratch.
template <class S>
struct SmootherVectors {
  std::span<const S> b;
  std::span<S> x, step, image;
};

/// Damps the eigenvectors of D⁻¹A with eigenvalues in [lower, upper]. A symmetric smoother: a fixed
/// polynomial in D⁻¹A.
struct Chebyshev {
  int degree = 2;
  double lower = 0.1, upper = 1.1;

  /// If `from_zero`, x counts as zero and its content is ignored. `multiply(x, y)`: y = A x; `relax(weights,
  /// b, image, step, x)`: the step above in one pass, with image = A x. Collective if these are.
  template <class S, class Multiply, class Relax>
  void smooth(bool from_zero, const SmootherVectors<S>& on, const Multiply& multiply,
              const Relax& relax) const {
    const double theta = 0.5 * (upper + lower), delta = 0.5 * (upper - lower), sigma = theta / delta;
    double rho = 1.0 / sigma;
    for (int k = 0; k < degree; ++k) {
      const bool first = k == 0, zero = first && from_zero;
      if (!zero) multiply(on.x, on.image);
      const double next = 1.0 / (2.0 * sigma - rho);
      const auto keep = static_cast<S>(first ? 0.0 : next * rho);
      const auto add = static_cast<S>(first ? 1.0 / theta : 2.0 * next / delta);
      if (!first) rho = next;
      relax(ChebyshevStep<S>{keep, add, zero, first}, on.b, on.image, on.step, on.x);
    }
  }
};

}  // namespace kacanov
