// SPDX-License-Identifier: BSD-3-Clause
// Chebyshev smoothing with whatever multiplies by A and by D⁻¹.
#pragma once

#include <cstddef>
#include <span>

namespace kacanov {

/// One step of the smoother, row by row: step = keep · step + add · D⁻¹(b − A x), x += step.
template <class S>
struct ChebyshevStep {
  S keep, add;
  bool from_zero;  ///< x is taken as zero, and A x with it; `step` and x may then be one vector
  bool first;      ///< `step` is taken as zero

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
  /// What becomes of an entry of `step` and x; `scaled`: of D⁻¹(b − A x).
  template <bool zero, bool no_step>
  void take(S scaled, S& step, S& x) const {
    step = no_step ? add * scaled : keep * step + add * scaled;
    x = zero ? step : x + step;
  }
};

/// Damps the eigenvectors of D⁻¹A with eigenvalues in [lower, upper]; a symmetric smoother, the same
/// polynomial in D⁻¹A every time.
struct Chebyshev {
  int degree = 2;
  double lower = 0.1, upper = 1.1;

  /// Vectors of one length, `step` and `image` scratch. With `from_zero` x is taken as zero, whatever it
  /// holds. `multiply(x, y)`: y = A x; `relax(weights, b, image, step, x)`: the step above in one pass,
  /// `image` A x.
  template <class S, class Multiply, class Relax>
  void smooth(bool from_zero, std::span<const S> b, std::span<S> x, std::span<S> step, std::span<S> image,
              const Multiply& multiply, const Relax& relax) const {
    const double theta = 0.5 * (upper + lower), delta = 0.5 * (upper - lower), sigma = theta / delta;
    double rho = 1.0 / sigma;
    for (int k = 0; k < degree; ++k) {
      const bool first = k == 0, zero = first && from_zero;
      if (!zero) multiply(x, image);
      const double next = 1.0 / (2.0 * sigma - rho);
      const auto keep = static_cast<S>(first ? 0.0 : next * rho);
      const auto add = static_cast<S>(first ? 1.0 / theta : 2.0 * next / delta);
      if (!first) rho = next;
      relax(ChebyshevStep<S>{keep, add, zero, first}, b, image, step, x);
    }
  }
};

}  // namespace kacanov
