// SPDX-License-Identifier: BSD-3-Clause
// Whether the penalties of ADMM are too small or too large: what is left at held rows against what moves at
// free ones.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "contact/traces.hpp"

namespace kacanov {

/// Of one iteration, for N and T: the largest displacement open at A, and the norm of the force that moved at
/// I.
struct BalanceSample {
  std::array<double, 2> held{}, moved{};
};

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

  /// Ends an iteration. Collective.
  void finish(const Traces& traces) {
    BalanceSample sample;
    for (std::size_t k = 0; k < 2; ++k) {
      if (k == 0)
        part_.normal = free_.normal;
      else
        part_.tangential = free_.tangential;
      sample.held[k] = traces.ranks().max_all(held_[k]);
      sample.moved[k] = traces.force_norm(part_);
      std::fill(part_.normal.begin(), part_.normal.end(), 0.0);
      std::fill(part_.tangential.begin(), part_.tangential.end(), 0.0);
      held_[k] = 0.0;
    }
    samples_.push_back(sample);
  }

  const std::vector<BalanceSample>& samples() const noexcept { return samples_; }

 private:
  ContactValues free_, part_;
  std::array<double, 2> held_{};
  std::vector<BalanceSample> samples_;
};

/// Mean of log (A behind / I behind) over the iterations, for N and T, with what the traces at A and the
/// forces at I are to be compared with; 0 where nothing was learnt.
inline std::array<double, 2> mean_behind(std::span<const BalanceSample> samples, double trace_scale,
                                         double force_scale) {
  constexpr double most = 3.0;  // where one side is empty the other cannot be infinitely behind
  std::array<double, 2> mean{};
  if (!(trace_scale > 0.0 && force_scale > 0.0)) return mean;
  for (std::size_t k = 0; k < 2; ++k) {
    int count = 0;
    for (const BalanceSample& sample : samples) {
      const double held = sample.held[k] / trace_scale, moved = sample.moved[k] / force_scale;
      if (!(held + moved > 0.0)) continue;
      mean[k] += (std::clamp(std::log(held / moved), -most, most) - mean[k]) / ++count;
    }
  }
  return mean;
}

}  // namespace kacanov
