// SPDX-License-Identifier: BSD-3-Clause
// Penalty and multiplier updates of the method of multipliers.
#pragma once

#include <algorithm>
#include <deque>
#include <string>

#include "contact/contact_state.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// The penalty adapts to the cost of rounds: a large one needs few rounds, a small one few Newton steps per
/// round. Anderson acceleration finds the fixed point of the map from the multipliers and bounds of one round
/// to the next, Coulomb's included, even if it is no contraction (theory: augmented-newton).
class AugmentedControl {
 public:
  explicit AugmentedControl(const Tuning& tuning) : tuning_(tuning) {}

  /// Starts rounds from another state; `penalty` is that of ADMM, 0 without contact.
  void begin(double penalty, double lambda_min);
  bool begun() const noexcept { return penalty_ > 0.0; }
  double penalty() const noexcept { return penalty_; }
  /// Sets the multipliers and bounds of the next round in the state, whose multipliers are the result of the
  /// last round. Collective.
  void advance(const Traces& traces, ContactState& state);
  /// Adapts the penalty to the number of Newton steps in the last round.
  void learn(int iterations);

  /// Visits the entries of a checkpoint: numbers, and multiplier vectors with the normal values of all points
  /// before the tangential ones.
  template <class Numbers, class Multipliers>
  void visit(const Numbers& number, const Multipliers& multipliers) {
    number("augmented_penalty", penalty_);
    number("augmented_most", most_);
    number("augmented_rounds", rounds_);
    number("augmented_last_size", last_size_);
    int changes = static_cast<int>(changes_.size());
    number("augmented_changes", changes);
    changes = std::clamp(changes, 0, tuning_.augmented_memory);
    changes_.resize(static_cast<std::size_t>(changes));
    if (rounds_ > 0) multipliers("augmented_from", from_);
    if (rounds_ > 1) {
      multipliers("augmented_rest", last_.rest);
      multipliers("augmented_image", last_.image);
    }
    for (int k = 0; k < changes; ++k) {
      multipliers("augmented_rest_" + std::to_string(k), changes_[static_cast<std::size_t>(k)].rest);
      multipliers("augmented_image_" + std::to_string(k), changes_[static_cast<std::size_t>(k)].image);
    }
  }

 private:
  Tuning tuning_;
  double penalty_ = 0.0, most_ = 0.0;
  /// Image of the multipliers under a round, and the residual: image minus start.
  struct Round {
    Vector rest, image;
  };
  int rounds_ = 0;             ///< started; the same on all ranks, including those without contact
  Vector from_;                ///< initial multipliers of the last round
  Round last_;                 ///< the previous round
  double last_size_ = 0.0;     ///< |rest|² of the previous round
  std::deque<Round> changes_;  ///< differences between rounds, newest first
  /// Returns the Anderson update: the combination of differences that minimises the residual. Collective.
  Vector mixed(const Traces& traces, const Round& now) const;
};

}  // namespace kacanov
