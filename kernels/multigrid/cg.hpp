// SPDX-License-Identifier: BSD-3-Clause
// Preconditioned conjugate gradients for any linear operator, with the vectors and sums they need.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace kacanov {

using Vector = std::vector<double>;

/// Σ term(i) over i < n with eight partial sums: the compiler may not reorder a single sum.
template <class Term>
double eight_sums(std::size_t n, const Term& term) {
  std::array<double, 8> s{};
  const std::size_t whole = n - n % 8;
  for (std::size_t i = 0; i < whole; i += 8)
    for (std::size_t k = 0; k < 8; ++k) s[k] += term(i + k);
  for (std::size_t i = whole; i < n; ++i) s[0] += term(i);
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

struct CgResult {
  int iterations = 0;
  double first_residual = 0.0, residual = 0.0;  ///< ‖r‖ in the space
  double energy = 0.0;  ///< δᵀA δ = δᵀr₀ of the correction δ that the solve has added to x
  bool converged = false;
};

/// Stopping criteria of a solve (theory: cg).
struct CgOptions {
  double absolute = 0.0;   ///< stop at ‖r‖ ≤ absolute ...
  double relative = 1e-8;  ///< ... or at ‖r‖ ≤ relative · ‖r₀‖
  int max_iterations = 2000;
  double most = std::numeric_limits<double>::infinity();  ///< maximum of ‖r‖ after a stop by `relative`
  double reach = 1.0;  ///< a solve that would stop within this factor of `absolute` continues to `absolute`

  /// Linearisation error at the present x: the residual of the nonlinear problem that the linear one neglects
  /// (theory: left-out); ‖r‖ need not fall below `share` of it. Called once, when ‖r‖ ≤ asked · ‖r₀‖ and the
  /// target is estimated to be at least `worth` iterations away.
  std::function<double()> left_out = {};
  double asked = 1.0, share = 1.0, worth = 0.0;

  /// ‖r‖ at which a solve with the initial residual `first` stops.
  double target(double first) const {
    const double wanted = std::min(relative * first, most);
    return wanted <= reach * absolute ? absolute : wanted;
  }
  /// Whether a solve in this state calls left_out().
  bool asks(const CgResult& sofar, double target) const {
    if (sofar.residual <= target || sofar.residual > asked * sofar.first_residual) return false;
    const double rate = std::log(sofar.first_residual / sofar.residual) / sofar.iterations;
    return std::log(sofar.residual / target) >= worth * rate;
  }
};

/// Work vectors, kept between solves.
struct CgWork {
  Vector residual, direction, image;  // image: A p, and before that M⁻¹ r
  void resize(std::size_t n) {
    for (Vector* v : {&residual, &direction, &image}) *v = Vector(n);
  }
};

/// Solves P A P δ = P r for the correction δ of x. On entry `work.residual` holds b − A x (projected here),
/// on exit the residual of the new x. `apply(p, q)`: q = A p, consistent, not projected; returns this rank's
/// part of pᵀq. `precondition(r, z)`: z ≈ A⁻¹ r, symmetric positive definite, consistent. A breakdown (pᵀAp
/// not positive: the operator is not definite) ends the loop unconverged. All vectors have the unknowns of
/// the space, a class with the interface of the solver's Space: project, dot, residual_norm, sum_all,
/// advance, turn. Collective if these are.
template <class InnerSpace, class Apply, class Precondition>
CgResult conjugate_gradients(const InnerSpace& space, const Apply& apply, const Precondition& precondition,
                             std::span<double> x, CgWork& work, const CgOptions& options) {
  CgResult result;
  auto& [r, p, q] = work;
  auto& z = q;  // used one after the other
  space.project(r);
  result.first_residual = result.residual = space.residual_norm(r);
  double target = options.target(result.first_residual);
  bool to_ask = static_cast<bool>(options.left_out);
  result.converged = result.residual <= target;
  double rz = 0.0;
  while (!result.converged && result.iterations < options.max_iterations) {
    precondition(r, z);
    space.project(z);
    const double rz_new =
        space.dot(r, z);  // only after the projection, which removes residuals that are only rounding errors
    if (!(rz_new > 0.0) || !std::isfinite(rz_new)) return result;
    space.turn(result.iterations == 0 ? 0.0 : rz_new / rz, z, p);
    rz = rz_new;
    const double pq = space.sum_all(apply(p, q));
    space.project(q);
    if (!(pq > 0.0) || !std::isfinite(pq)) return result;
    const double length = rz / pq;
    result.energy += length * rz;
    result.residual = space.advance(length, p, q, x, r);
    ++result.iterations;
    if (to_ask && options.asks(result, target)) {
      target = std::max(target, options.share * options.left_out());
      to_ask = false;
    }
    result.converged = result.residual <= target;
  }
  return result;
}

}  // namespace kacanov
