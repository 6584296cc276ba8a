// SPDX-License-Identifier: BSD-3-Clause
// Penalty and multipliers of the method of multipliers, from one of its rounds to the next.
#pragma once

#include <deque>

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
  double penalty() const noexcept { return penalty_; }
  /// Puts the multipliers and bounds of the next round into the state, whose multipliers are what the last
  /// one came to. Collective.
  void advance(const Traces& traces, ContactState& state);
  /// Newton steps that the last round took.
  void learn(int iterations);

  /// Entries of a checkpoint.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("augmented_penalty", penalty_);
    entry("augmented_most", most_);
  }

 private:
  Tuning tuning_;
  double penalty_ = 1.0, most_ = 1.0;
  Vector from_;  ///< multipliers that the last round began with; empty before the first
  Vector last_rest_, last_image_;
  struct Change {
    Vector rest, image;
  };
  std::deque<Change> changes_;
  double last_size_ = 0.0;
};

}  // namespace kacanov
