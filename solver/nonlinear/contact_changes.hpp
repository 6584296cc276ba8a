// SPDX-License-Identifier: BSD-3-Clause
// Which contact points change their state from step to step.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/contact_state.hpp"

namespace kacanov {

/// For whoever has to say why a run does not converge. It steers nothing, and no checkpoint has it.
class ContactChanges {
 public:
  static constexpr int window = 16;  ///< outer steps that are looked back on

  /// After an outer step.
  void note(std::span<const ContactPoint> points, const ContactState& state) {
    const bool known = !now_.empty();
    now_.resize(points.size());
    changed_.resize(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint8_t next = state_of(points[i], state, i);
      changed_[i] = static_cast<std::uint16_t>(changed_[i] << 1 | (known && next != now_[i] ? 1 : 0));
      now_[i] = next;
    }
  }
  void start_again() {
    now_.clear();
    changed_.clear();
  }

  /// In how many of the last steps a point was another than in the step before.
  int count(std::size_t point) const { return point < changed_.size() ? std::popcount(changed_[point]) : 0; }

 private:
  enum : std::uint8_t { open, sticks, slips };
  std::vector<std::uint8_t> now_;
  std::vector<std::uint16_t> changed_;  ///< a bit a step

  static std::uint8_t state_of(const ContactPoint& point, const ContactState& state, std::size_t i) {
    if (point.tangents == 0 || state.bound[i] == 0.0) return state.lambda.normal[i] > 0.0 ? slips : open;
    const double* friction = &state.lambda.tangential[2 * i];
    // The projection leaves |λ_t| = ψ to rounding; a Coulomb's ψ has moved on since.
    constexpr double at_bound = 1.0 - 1e-10;
    return std::hypot(friction[0], friction[1]) >= at_bound * state.bound[i] ? slips : sticks;
  }
};

}  // namespace kacanov
