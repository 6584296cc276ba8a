// SPDX-License-Identifier: BSD-3-Clause
// When a preconditioner is worth setting up again.
#include "nonlinear/preconditioner_schedule.hpp"

#include <algorithm>

namespace kacanov {

bool PreconditionerSchedule::far(double now, double then) const {
  return now > tuning_.penalty_worth * then || then > tuning_.penalty_worth * now;
}

bool PreconditionerSchedule::penalty_moved(const Penalty& now, bool friction) const {
  return far(now.normal, penalty_.normal) || (friction && far(now.tangential, penalty_.tangential));
}

bool PreconditionerSchedule::set_moved(const ActiveSet& set, double penalty) const {
  return held_by_ != penalty || set.held != pinned_ ||
         !std::equal(set.slip_stiffness.begin(), set.slip_stiffness.end(), slip_stiffness_.begin(),
                     [this](double now, double then) { return !far(now, then); });
}

void PreconditionerSchedule::built() {
  stale_ = false;
  digits_per_cg_ = lost_per_digit_ = 0.0;
}

void PreconditionerSchedule::built_for(const Penalty& penalty) {
  penalty_ = penalty;
  pinned_.clear(), slip_stiffness_.clear();
}

void PreconditionerSchedule::built_for(const ActiveSet& set, double penalty) {
  pinned_ = set.held, slip_stiffness_ = set.slip_stiffness;
  held_by_ = penalty;
}

void PreconditionerSchedule::watch(double digits, std::int64_t iterations) {
  if (iterations == 0) return;
  const auto taken = static_cast<double>(iterations);
  if (digits_per_cg_ == 0.0) digits_per_cg_ = digits / taken;
  const double lost = taken - digits / digits_per_cg_;
  if (lost > tuning_.setup_worth) lost_per_digit_ = digits > 0.0 ? lost / digits : HUGE_VAL;
}

}  // namespace kacanov
