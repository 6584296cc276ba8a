// SPDX-License-Identifier: BSD-3-Clause
// Generalised conjugate residuals with inner solves, for operators that are nearly symmetric, such as with
// pressure-dependent friction.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "linear/space.hpp"

namespace kacanov {

struct GcrOptions {
  double absolute = 0.0;  ///< stop at ‖r‖ ≤ absolute
  int max_iterations = 20;
};

struct GcrResult {
  int iterations = 0;
  double first_residual = 0.0, residual = 0.0;
  bool converged = false;
};

/// The solution, and `residual` = b − A x in the space.
struct GcrVectors {
  std::span<double> x, residual;
};

/// Solves A x = b for a possibly nonsymmetric A. Updates both vectors.
/// `inner(r, z)` sets z ≈ A⁻¹ r and returns whether it succeeded; `apply(z, q)` sets q = A z in the space.
/// Stores two vectors of the part's unknowns per iteration. Collective.
template <class Apply, class Inner>
GcrResult gcr(const Space& space, const Apply& apply, const Inner& inner, const GcrVectors& vectors,
              const GcrOptions& options) {
  const auto& [x, residual] = vectors;
  struct Direction {
    Vector z, q;
    double square = 0.0;
  };
  std::vector<Direction> kept;
  GcrResult result;
  result.first_residual = result.residual = space.residual_norm(residual);
  result.converged = result.residual <= options.absolute;
  const std::size_t n = x.size();
  while (!result.converged && result.iterations < options.max_iterations) {
    Direction next{Vector(n), Vector(n)};
    if (!inner(residual, next.z)) break;
    apply(next.z, next.q);
    for (const Direction& d : kept) {
      const double share = space.dot(d.q, next.q) / d.square;
      for (std::size_t i = 0; i < n; ++i) {
        next.z[i] -= share * d.z[i];
        next.q[i] -= share * d.q[i];
      }
    }
    const auto [square, along] = space.dot2(next.q, next.q, next.q, residual);
    if (!(square > 0.0) || !std::isfinite(along)) break;
    next.square = square;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += along / square * next.z[i];
      residual[i] -= along / square * next.q[i];
    }
    ++result.iterations;
    result.residual = space.residual_norm(residual);
    result.converged = result.residual <= options.absolute;
    kept.push_back(std::move(next));
  }
  return result;
}

}  // namespace kacanov
