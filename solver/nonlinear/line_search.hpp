// SPDX-License-Identifier: BSD-3-Clause
// How far to go along a direction that lowers a convex function.
#pragma once

#include <algorithm>
#include <cmath>

namespace kacanov {

struct LineSearchOptions {
  double steep = 0.5;  ///< share of the first slope that may be left falling ...
  double past = 0.2;   ///< ... or rising, past the lowest point
  int most_trials = 20;
  double longest = 1.0;  ///< where φ falls as steeply as that at 1, go on up to here
};

/// t in (0, longest] where φ falls or rises by little, for convex φ with φ'(0) = `first` < 0: the longest
/// where φ falls there. `slope(t)` gives φ'(t), and leaves its caller at t; the last t asked about is
/// returned. Regula falsi (Illinois), so that slopes that grow by orders of magnitude along the way are found
/// as well.
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
      // Illinois: a side that stays twice counts half.
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
