// SPDX-License-Identifier: BSD-3-Clause
// From Newton steps that get nowhere back to ADMM, and from there to Newton again.
#pragma once

#include <cmath>

#include "nonlinear/tuning.hpp"

namespace kacanov {

/// Tells a stall of semismooth Newton steps, then asks for ADMM steps: a number that doubles with every
/// retreat, fewer where they reach a tenth of the best residual before (theory: active-set).
class Fallback {
 public:
  explicit Fallback(const Tuning& tuning) : tuning_(tuning) {}

  /// Whether ADMM is to take the next step.
  bool retreating() const noexcept { return steps_left_ > 0; }
  /// `worst`: largest KKT residual after the step; `solved`: its linear problems were.
  void after_admm(double worst, bool solved = true);
  /// The same for a Newton step; `solved`: its linear problem was. Whether a retreat begins.
  bool after_newton(double worst, bool solved);
  /// Whether nothing has been gained for so long that nothing is to be hoped for.
  bool stuck() const noexcept { return idle_ >= tuning_.most_idle; }
  void start_again() { *this = Fallback(tuning_); }

  /// Entries of a checkpoint.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("best", best_);
    entry("stalled", stalled_);
    entry("retreat", steps_left_);
    entry("aim", aim_);
    entry("retreats", retreats_);
    entry("lowest", lowest_);
    entry("idle", idle_);
  }

 private:
  Tuning tuning_;
  double best_ = HUGE_VAL;  ///< smallest residual since the last retreat
  int stalled_ = 0;         ///< Newton steps without a new best residual
  int steps_left_ = 0;      ///< ADMM steps still to take
  double aim_ = 0.0;        ///< residual at which they end early
  int retreats_ = 0;
  double lowest_ = HUGE_VAL;  ///< residual that counts as the last gain
  int idle_ = 0;              ///< steps since
  void count(double worst);
};

}  // namespace kacanov
