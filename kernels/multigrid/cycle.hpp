// SPDX-License-Identifier: BSD-3-Clause
// The multigrid cycle, and the parts of all levels: Chebyshev smoothing, the largest eigenvalue that it
// needs, and solves with the Schur complement of pressures.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>
#include "operator/threads.hpp"

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

/// One cycle from level k down, x = C b with C symmetric if the smoothers are. `levels` provides smooth(k,
/// before), from x = 0 if before; restrict_residual(k), to the next level's b; add_correction(k), from the
/// next level's x; corrections(k), 1 in a V-cycle and 2 in a W-cycle; is_last(k); solve_last(). Collective.
template <class Levels>
void cycle(Levels& levels, std::size_t k = 0) {
  if (levels.is_last(k)) return levels.solve_last();
  levels.smooth(k, true);
  for (int left = levels.corrections(k); left > 0; --left) {
    levels.restrict_residual(k);
    cycle(levels, k + 1);
    levels.add_correction(k);
  }
  levels.smooth(k, false);
}

/// Returns a pseudorandom number in [−1, 1] that depends only on the index.
inline float scatter(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15U;  // splitmix64
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<float>(static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0);
}

/// Start vector for largest_eigenvalue: `components` scatter()ed entries per index of the map.
template <class S>
std::vector<S> scattered(const IndexMap& map, std::size_t components) {
  std::vector<S> x(map.size() * components);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = static_cast<S>(
        scatter(static_cast<std::uint64_t>(map.number(i / components)) * components + i % components));
  return x;
}

/// Λ (theory: chebyshev): Lanczos' estimate after ten steps of conjugate gradients preconditioned by D, plus
/// a tenth because it is a lower bound; 1 if the start is zero. `r` holds the start and is overwritten.
/// `multiply(x, y)`: y = A x; `scale(x, y)`: y = D⁻¹ x, on vectors of r's length; `dot` sums over owned
/// entries and all ranks. Collective if these are.
template <class S, class Multiply, class Scale, class Dot>
double largest_eigenvalue(std::vector<S>& r, const Multiply& multiply, const Scale& scale, const Dot& dot) {
  constexpr int steps = 10;
  std::vector<S> z(r.size()), p(r.size()), q(r.size());
  std::vector<double> diagonal, off;
  double rz = 0.0, alpha = 1.0;
  for (int k = 0; k < steps; ++k) {
    scale(std::span<const S>(r), std::span<S>(z));
    const double rz_new = dot(r, z);
    if (!(rz_new > 0.0)) break;
    const double beta = k == 0 ? 0.0 : rz_new / rz;
    rz = rz_new;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = k == 0 ? z[i] : z[i] + static_cast<S>(beta) * p[i];
    multiply(std::span<S>(p), std::span<S>(q));
    const double pq = dot(p, q);
    if (!(pq > 0.0)) break;
    const double before = alpha;
    alpha = rz / pq;
    diagonal.push_back(1.0 / alpha + (k == 0 ? 0.0 : beta / before));
    if (k > 0) off.push_back(std::sqrt(beta) / before);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= static_cast<S>(alpha) * q[i];
  }
  if (diagonal.empty()) return 1.0;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(
      Eigen::Map<const Eigen::VectorXd>(diagonal.data(), static_cast<Eigen::Index>(diagonal.size())),
      Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size())),
      Eigen::EigenvaluesOnly);
  return 1.1 * solver.eigenvalues().maxCoeff();
}

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
