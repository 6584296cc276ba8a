// SPDX-License-Identifier: BSD-3-Clause
// From Newton steps that get nowhere back to ADMM, and from there to Newton again.
#include "nonlinear/fallback.hpp"

#include <algorithm>

namespace kacanov {

void Fallback::count(double worst) {
  ++idle_;
  if (!(worst < tuning_.gain * lowest_)) return;
  lowest_ = worst;
  idle_ = 0;
}

void Fallback::after_admm(double worst, bool solved) {
  count(worst);
  if (!solved && idle_ > 0) idle_ += tuning_.unsolved_worth - 1;
  steps_left_ = worst <= aim_ ? 0 : std::max(0, steps_left_ - 1);
}

bool Fallback::after_newton(double worst, bool solved) {
  count(worst);
  stalled_ = worst < tuning_.progress * best_ ? 0 : stalled_ + 1;
  best_ = std::min(best_, worst);
  if (solved && stalled_ < tuning_.patience && std::isfinite(worst)) return false;
  // ADMM converges from anywhere; every retreat is longer than the last.
  stalled_ = 0;
  aim_ = std::isfinite(best_) ? tuning_.retreat_gain * best_ : 0.0;
  best_ = HUGE_VAL;
  steps_left_ = tuning_.first_retreat << std::min(retreats_++, tuning_.most_doublings);
  return true;
}

}  // namespace kacanov
