// SPDX-License-Identifier: BSD-3-Clause
// Whether the penalties of ADMM are too small or too large: what is left at held rows against what moves at
// free ones.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/traces.hpp"

namespace kacanov {

/// With A the held rows (touching, sticking, and across its slip a slipping point in 3D) and I the free ones,
/// an error at A decays by 1/(1 + r λ(K_AA)) an iteration and one at I by r λ(K_I|A)/(1 + r λ(K_I|A)): a
/// larger r speeds up the one and slows down the other. Both show, as a displacement at A and as a force at
/// I. The best r brings both to their tolerances at the same time, so r is raised while A is behind and
/// lowered while I is. N and T have a balance each. Usual residual balancing (the whole w − φ against the
/// whole r Δφ) sees the two mixed by over-relaxation: it took 107 iterations where this takes 52 (rocker,
/// elastic, frictionless).
class Balance {
 public:
  explicit Balance(std::size_t points) : free_(points), part_(points) {}

  /// One iteration at contact point i: what is open at a held row, the force still moving at a free one (else
  /// 0).
  void normal(std::size_t i, double held, double free) {
    held_[0] = std::max(held_[0], std::abs(held));
    free_.normal[i] = free;
  }
  void tangential(std::size_t i, double held, std::array<double, 2> free) {
    held_[1] = std::max(held_[1], std::abs(held));
    free_.tangential[2 * i] = free[0];
    free_.tangential[2 * i + 1] = free[1];
  }

  /// Ends an iteration. Collective. Tolerances as in AdmmOptions; an infinite one leaves the balance alone.
  void finish(const Traces& traces, double trace_tolerance, double force_tolerance) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (k == 0)
        part_.normal = free_.normal;
      else
        part_.tangential = free_.tangential;
      const double held = traces.halo().max_all(held_[k]) / trace_tolerance;
      const double moved = traces.force_norm(part_) / force_tolerance;
      std::fill(part_.normal.begin(), part_.normal.end(), 0.0);
      std::fill(part_.tangential.begin(), part_.tangential.end(), 0.0);
      held_[k] = 0.0;
      if (std::isinf(trace_tolerance) || !(held + moved > 0.0)) continue;
      const double behind = std::clamp(std::log(held / moved), -most, most);
      mean_[k] += (behind - mean_[k]) / ++count_[k];
    }
  }

  /// Mean of log (A behind / I behind) over the iterations, for N and T; 0 where nothing was learnt.
  std::array<double, 2> mean() const noexcept { return mean_; }

 private:
  static constexpr double most = 3.0;  // where one side is empty the other cannot be infinitely behind
  ContactValues free_, part_;
  std::array<double, 2> held_{}, mean_{};
  std::array<int, 2> count_{};
};

}  // namespace kacanov
