// SPDX-License-Identifier: BSD-3-Clause
// How far an obstacle has to be pushed for the body to bear a force (theory: force-control).
#pragma once

#include <cmath>
#include <functional>
#include <optional>

namespace kacanov {

struct PushedObstacle {
  double force = 0.0;        ///< ≥ 0
  double tolerance = 1e-5;   ///< relative, on the force
  double touch = 0.0;        ///< travel at which it reaches the undeformed body
  double travel = HUGE_VAL;  ///< to begin with; none: beyond touch by `scale`
  double scale = 0.0;        ///< of travels, > 0 unless force is 0
  int most = 40;             ///< solves

  bool meets(double found) const { return std::abs(found - force) <= tolerance * force; }
};

struct PushOutcome {
  bool reached = false;
  double travel = 0.0, force = 0.0;  ///< of the last solve
  int solves = 0;
};

/// Finds the travel at which `force_at` is the force: grows or halves what is beyond touch until two travels
/// enclose it, then by regula falsi with the Illinois rule. `force_at` does not fall with the travel; nothing
/// from it ends the search. The last travel it was asked for is the outcome's.
PushOutcome find_travel(const PushedObstacle& pushed,
                        const std::function<std::optional<double>(double)>& force_at);

}  // namespace kacanov
