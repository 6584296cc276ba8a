// SPDX-License-Identifier: BSD-3-Clause
// Chebyshev smoothing with whatever multiplies by A and by D⁻¹.
#pragma once

#include <cstddef>
#include <span>

namespace kacanov {

/// Damps the eigenvectors of D⁻¹A with eigenvalues in [lower, upper]; a symmetric smoother, the same polynomial in D⁻¹A
/// every time.
struct Chebyshev {
  int degree = 2;
  double lower = 0.1, upper = 1.1;

  /// Vectors of one length, `step` and `image` scratch. With `from_zero` x is taken as zero, whatever it holds. `multiply(x, y)`: y = A x;
  /// `scale(r, z)`: z = D⁻¹ r.
  template <class S, class Multiply, class Scale>
  void smooth(bool from_zero, std::span<const S> b, std::span<S> x, std::span<S> step, std::span<S> image,
              const Multiply& multiply, const Scale& scale) const {
    const double theta = 0.5 * (upper + lower), delta = 0.5 * (upper - lower), sigma = theta / delta;
    const std::size_t n = b.size();
    double rho = 1.0 / sigma;
    for (int k = 0; k < degree; ++k) {
      const bool zero = k == 0 && from_zero;
      if (zero) {
        scale(b, image);
      } else {
        multiply(x, image);
        for (std::size_t i = 0; i < n; ++i) image[i] = b[i] - image[i];
        scale(image, image);
      }
      const double next = 1.0 / (2.0 * sigma - rho);
      const auto keep = static_cast<S>(k == 0 ? 0.0 : next * rho);
      const auto add = static_cast<S>(k == 0 ? 1.0 / theta : 2.0 * next / delta);
      if (k > 0) rho = next;
      for (std::size_t i = 0; i < n; ++i) {
        step[i] = k == 0 ? add * image[i] : keep * step[i] + add * image[i];
        x[i] = zero ? step[i] : x[i] + step[i];
      }
    }
  }
};

}  // namespace kacanov
