// SPDX-License-Identifier: BSD-3-Clause
// Where along the load steps of a case a state is, and what the step before has left.
#pragma once

#include <nlohmann/json.hpp>

#include "verify/real.hpp"

namespace kacanov::verify {

/// The end of a load step, or of the part of it that the run has reached (theory: slip-history).
struct LoadPoint {
  std::size_t step = 0;             ///< from 0
  Real load = 1;                    ///< factor, or time of the load curves
  Real begin = 0, end = 1;          ///< of the step: obstacles with a motion are where they are at its end
  std::vector<Real> travel;         ///< of each contact entry that is pushed by a force; 0 of others
  std::vector<Real> travel_before;  ///< at the end of the step before
  std::vector<Vec> before;          ///< displacement of each node there; empty: rest
};

/// The load steps that the result has an end of: those before the last as `load_steps` has them, and where
/// the run has ended. Throws Failure where the result is not of this case.
std::vector<LoadPoint> load_points(const nlohmann::json& document, const nlohmann::json& result);

/// Whether the state of a step depends on the displacement at the end of the one before.
bool has_history(const nlohmann::json& document);

/// Whether slip at a contact entry counts from the end of the load step before.
bool counts_from_step(const nlohmann::json& entry);

}  // namespace kacanov::verify
