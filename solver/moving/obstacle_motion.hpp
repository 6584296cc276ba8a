// SPDX-License-Identifier: BSD-3-Clause
// Position of an obstacle: the pose prescribed by its motion, or the travel at which it bears its force.
#pragma once

#include <cmath>
#include <functional>
#include <optional>

#include <kacanov/model.hpp>
#include "problem/vector3.hpp"

namespace kacanov {

/// The map x → c + R (x − c) + t (theory: moving-obstacles).
struct RigidPose {
  Vector3 centre{}, shift{}, rotation{};

  /// Returns the pose of a motion at a time: linear between the points of its path.
  static RigidPose at(const Motion& motion, double time) {
    Motion::Pose before, after;
    for (const Motion::Pose& next : motion.path) {
      after = next;
      if (next.time >= time) break;
      before = next;
    }
    const double whole = after.time - before.time;
    const double share = whole > 0.0 ? std::min((time - before.time) / whole, 1.0) : 1.0;
    return {motion.centre, before.translation + share * (after.translation - before.translation),
            before.rotation + share * (after.rotation - before.rotation)};
  }

  /// Rotates v by Rodrigues' formula.
  Vector3 turned(const Vector3& v, double sign = 1.0) const {
    const double angle = norm(rotation);
    if (angle == 0.0) return v;
    const Vector3 axis = (1.0 / angle) * rotation;
    return std::cos(angle) * v + (sign * std::sin(angle)) * cross(axis, v) +
           ((1.0 - std::cos(angle)) * dot(axis, v)) * axis;
  }
  /// Returns the displacement of x, accurate even if it is small.
  Vector3 carried(const Vector3& x) const {
    const double angle = norm(rotation);
    if (angle == 0.0) return shift;
    const Vector3 axis = (1.0 / angle) * rotation, across = cross(axis, x - centre);
    const double half = std::sin(0.5 * angle);
    return std::sin(angle) * across + (2.0 * half * half) * cross(axis, across) + shift;
  }
  Vector3 back(const Vector3& x) const { return centre + turned(x - shift - centre, -1.0); }
};

struct PushedObstacle {
  double force = 0.0;        ///< ≥ 0
  double tolerance = 1e-5;   ///< relative tolerance on the force
  double touch = 0.0;        ///< travel at which the obstacle reaches the undeformed body
  double travel = HUGE_VAL;  ///< initial value; infinite: `touch` + `scale`
  double scale = 0.0;        ///< scale of travels, > 0 unless force is 0
  int most = 40;             ///< maximum number of solves

  bool meets(double found) const { return std::abs(found - force) <= tolerance * force; }
};

struct PushOutcome {
  bool reached = false;
  double travel = 0.0, force = 0.0;  ///< of the last solve
  int solves = 0;
};

/// Finds the travel at which `force_at` equals the force: grows or halves the travel beyond touch until two
/// travels bracket it, then uses regula falsi with the Illinois rule. `force_at` must not decrease with the
/// travel; an empty result ends the search. The outcome contains the last travel evaluated.
PushOutcome find_travel(const PushedObstacle& pushed,
                        const std::function<std::optional<double>(double)>& force_at);

}  // namespace kacanov
