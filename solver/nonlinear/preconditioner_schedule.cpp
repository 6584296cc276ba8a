// SPDX-License-Identifier: BSD-3-Clause
// When a preconditioner is worth setting up again.
#include "nonlinear/preconditioner_schedule.hpp"

#include <algorithm>

namespace kacanov {

bool PreconditionerSchedule::penalty_moved(const Penalty& now, bool friction) const {
  const auto far = [&](double here, double then) {
    return here > tuning_.penalty_worth * then || then > tuning_.penalty_worth * here;
  };
  return far(now.normal, penalty_.normal) || (friction && far(now.tangential, penalty_.tangential));
}

bool PreconditionerSchedule::set_moved(std::span<const TraceChoice> held, double penalty) const {
  return held_by_ != penalty || !std::equal(held.begin(), held.end(), pinned_.begin(), pinned_.end());
}

void PreconditionerSchedule::built() {
  stale_ = false;
  digits_per_cg_ = lost_per_digit_ = 0.0;
}

void PreconditionerSchedule::built_for(const Penalty& penalty) {
  penalty_ = penalty;
  pinned_.clear();
}

void PreconditionerSchedule::watch(double digits, std::int64_t iterations) {
  if (iterations == 0) return;
  const auto taken = static_cast<double>(iterations);
  if (digits_per_cg_ == 0.0) digits_per_cg_ = digits / taken;
  const double lost = taken - digits / digits_per_cg_;
  if (lost > tuning_.setup_worth) lost_per_digit_ = digits > 0.0 ? lost / digits : HUGE_VAL;
}

}  // namespace kacanov
