// SPDX-License-Identifier: BSD-3-Clause
// Travel of an obstacle at which the body bears a given force (theory: force-control).
#include "moving/obstacle_motion.hpp"

#include <algorithm>

namespace kacanov {
namespace {

/// A travel, and the excess of its force over the target.
struct Trial {
  double travel = 0.0, excess = 0.0;
};

}  // namespace

PushOutcome find_travel(const PushedObstacle& pushed,
                        const std::function<std::optional<double>(double)>& force_at) {
  PushOutcome outcome;
  std::optional<Trial> low, high;
  double next = std::isfinite(pushed.travel) ? pushed.travel : pushed.touch + pushed.scale;
  bool was_above = false;
  double back = std::max(pushed.scale, std::abs(next - pushed.touch));
  for (; outcome.solves < pushed.most; ++outcome.solves) {
    outcome.travel = next;
    const std::optional<double> force = force_at(next);
    if (!force) return outcome;
    outcome.force = *force;
    const Trial here{next, *force - pushed.force};
    outcome.reached = pushed.meets(*force);
    if (outcome.reached) return outcome;
    const bool above = here.excess > 0.0;
    (above ? high : low) = here;
    // Illinois rule: halve the value of an end that is kept a second time.
    std::optional<Trial>& other = above ? low : high;
    if (other && outcome.solves > 0 && above == was_above) other->excess *= 0.5;
    was_above = above;
    if (low && high) {
      const double share = low->excess / (low->excess - high->excess);
      next = low->travel + std::clamp(share, 0.001, 0.999) * (high->travel - low->travel);
    } else if (low) {
      const double beyond = low->travel - pushed.touch, bears = std::max(*force, 0.0);
      const double growth = bears > 0.0 ? std::clamp(1.02 * pushed.force / bears, 1.05, 4.0) : 4.0;
      next = beyond > 0.0 ? pushed.touch + growth * beyond : pushed.touch + pushed.scale;
    } else {
      // Near touch the force is dominated by rounding, so do not step exactly to touch, but beyond it, or
      // well before it.
      const double beyond = high->travel - pushed.touch;
      if (beyond > 0.01 * back) {
        next = pushed.touch + std::clamp(0.98 * pushed.force / *force, 0.1, 0.9) * beyond;
      } else {
        next = std::min(high->travel, pushed.touch) - back;
        back *= 2.0;
      }
    }
  }
  return outcome;
}

}  // namespace kacanov
