// SPDX-License-Identifier: BSD-3-Clause
// When a preconditioner is worth setting up again.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "contact/active_set.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// What a preconditioner was set up for, how well it has served since, and whether another would pay. Knows
/// nothing of the preconditioner itself; every question is about this rank.
class PreconditionerSchedule {
 public:
  explicit PreconditionerSchedule(const Tuning& tuning) : tuning_(tuning) {}

  /// Whether it is due whatever else: there is none, or it has served its time, and what it would lose in so
  /// many decimal digits more is worth a setup.
  bool stale(double digits = HUGE_VAL) const noexcept {
    return stale_ || (lost_per_digit_ > 0.0 && lost_per_digit_ * digits > tuning_.setup_worth);
  }
  void mark_stale() noexcept { stale_ = true; }
  /// Whether g is too far from that of the last setup: sums over all points of |g − g then| and of g then.
  bool drifted(double change, double size) const noexcept { return change > tuning_.drift_worth * size; }
  /// Whether it was built with penalties that are far from these.
  bool penalty_moved(const Penalty& now, bool friction) const;
  /// Whether it holds other rows than the set, or none at all, or by another penalty (0: pins them), or
  /// has a slip somewhere that is far stiffer or softer than now. Every node it gets wrong costs CG a few
  /// iterations.
  bool set_moved(const ActiveSet& set, double penalty = 0.0) const;

  /// It was set up with a new g.
  void built();
  void built_for(const Penalty& penalty);
  void built_for(const ActiveSet& set, double penalty = 0.0);
  /// Learns from a solve: decimal digits gained, CG iterations. The first one after a setup is what it can
  /// do; one that needs more than that by what a setup is worth makes it stale.
  void watch(double digits, std::int64_t iterations);

  /// Entries of a checkpoint; the set that it was built for is told by built_for().
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("setup_stale", stale_);
    entry("setup_digits_per_cg", digits_per_cg_);
    entry("setup_lost_per_digit", lost_per_digit_);
    entry("setup_penalty_normal", penalty_.normal);
    entry("setup_penalty_tangential", penalty_.tangential);
    entry("setup_held_by", held_by_);
  }

 private:
  bool far(double now, double then) const;

  Tuning tuning_;
  bool stale_ = true;
  double digits_per_cg_ = 0.0;  ///< right after the last setup; 0: not known
  /// CG iterations that the last solve took beyond those, a digit; 0: not worth a setup.
  double lost_per_digit_ = 0.0;
  Penalty penalty_;
  std::vector<TraceChoice> pinned_;
  Vector slip_stiffness_;
  double held_by_ = 0.0;  ///< penalty of those rows; 0: pinned
};

}  // namespace kacanov
