// SPDX-License-Identifier: BSD-3-Clause
// Line search along a descent direction of a convex function.
#pragma once

#include <algorithm>
#include <cmath>

namespace kacanov {

struct LineSearchOptions {
  double steep = 0.5;  ///< accepted remaining share of the initial slope while falling ...
  double past = 0.2;   ///< ... or rising, beyond the minimum
  int most_trials = 20;
  double longest = 1.0;  ///< extends the step up to this length while φ falls as steeply as at 1
};

/// Returns t in (0, longest] at which the convex φ, with φ'(0) = `first` < 0, has a small slope, or `longest`
/// if it still falls there. `slope(t)` returns φ'(t) and moves the caller's state to t; the last t evaluated
/// is returned. Regula falsi (Illinois) copes with slopes that grow by orders of magnitude.
template <class Slope>
double find_step(double first, const Slope& slope, const LineSearchOptions& options = {}) {
  double low = 0.0, high = 0.0, low_slope = first, high_slope = 0.0, t = 1.0;
  for (int trial = 1;; ++trial) {
    const double here = slope(t);
    const bool falls = here <= 0.0;
    if (falls && (t == options.longest || -here <= options.steep * -first)) return t;
    if (!falls && here <= options.past * -first) return t;
    if (trial >= options.most_trials) return t;
    if (falls && high == 0.0) {
      constexpr double growth = 8.0;
      low = t;
      low_slope = here;
      t = std::min(options.longest, growth * t);
      continue;
    }
    if (falls) {
      // Illinois rule: halve the slope of an end that is kept a second time.
      if (low > 0.0 && high > 0.0) high_slope *= 0.5;
      low = t;
      low_slope = here;
    } else {
      if (high > 0.0) low_slope *= 0.5;
      high = t;
      high_slope = here;
    }
    const double width = high - low;
    const double share = std::isfinite(high_slope) ? low_slope / (low_slope - high_slope) : 0.1;
    t = low + width * std::clamp(share, 0.05, 0.95);
  }
}

}  // namespace kacanov
