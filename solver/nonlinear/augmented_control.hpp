// SPDX-License-Identifier: BSD-3-Clause
// Penalty and multipliers of the method of multipliers, from one of its rounds to the next.
#pragma once

#include <algorithm>
#include <deque>
#include <string>

#include "contact/contact_state.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// The penalty follows what rounds take: a stiff one leaves few rounds, a soft one few Newton steps in each.
/// A round maps multipliers, with the bounds that their pressure gives, to others; Anderson's acceleration
/// finds the fixed point of that map, Coulomb's included, also where the map itself does not contract
/// (theory: augmented-newton).
class AugmentedControl {
 public:
  explicit AugmentedControl(const Tuning& tuning) : tuning_(tuning) {}

  /// For rounds from another state: `penalty` is that of ADMM; 0 where there is no contact.
  void begin(double penalty, double lambda_min);
  bool begun() const noexcept { return penalty_ > 0.0; }
  double penalty() const noexcept { return penalty_; }
  /// Puts the multipliers and bounds of the next round into the state, whose multipliers are what the last
  /// one came to. Collective.
  void advance(const Traces& traces, ContactState& state);
  /// Newton steps that the last round took.
  void learn(int iterations);

  /// Entries of a checkpoint: numbers, and multipliers as rounds have them, first the normal ones of all
  /// points, then the tangential ones.
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
  /// What a round has made of its multipliers: the image of the map, and what that is off by.
  struct Round {
    Vector rest, image;
  };
  int rounds_ = 0;             ///< begun; the same on all ranks, of which some have no contact
  Vector from_;                ///< multipliers that the last one began with
  Round last_;                 ///< the one before
  double last_size_ = 0.0;     ///< |rest|² of that
  std::deque<Round> changes_;  ///< from round to round, the newest first
  /// What the changes say about where nothing is off any more. Collective.
  Vector mixed(const Traces& traces, const Round& now) const;
};

}  // namespace kacanov
