// SPDX-License-Identifier: BSD-3-Clause
// The point of the load path that a state belongs to, with the history from the previous load step.
#pragma once

#include <nlohmann/json.hpp>

#include "verify/real.hpp"

namespace kacanov::verify {

/// The end of a load step, or the point within it that the run has reached (theory: slip-history).
struct LoadPoint {
  std::size_t step = 0;             ///< from 0
  Real load = 1;                    ///< load factor, or time of the load curves
  Real begin = 0, end = 1;          ///< of the step; a moving obstacle is at its position at `end`
  std::vector<Real> travel;         ///< of each force-controlled contact entry; 0 for the others
  std::vector<Real> travel_before;  ///< at the end of the previous step
  std::vector<Vec> before;          ///< displacement of each node there; empty: zero
};

/// Returns the load steps with a result: those before the last from `load_steps`, and the end of the run.
/// Throws Failure if the result does not belong to the case.
std::vector<LoadPoint> load_points(const nlohmann::json& document, const nlohmann::json& result);

/// Returns whether the state of a step depends on the displacement at the end of the previous one.
bool has_history(const nlohmann::json& document);

/// Returns whether slip of a contact entry counts from the end of the previous load step.
bool counts_from_step(const nlohmann::json& entry);

}  // namespace kacanov::verify
