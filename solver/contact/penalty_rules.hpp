// SPDX-License-Identifier: BSD-3-Clause
// Published rules for one penalty of ADMM, as rivals of the balance (theory: penalty-rules).
#pragma once

#include <kacanov/model.hpp>
#include "contact/traces.hpp"

namespace kacanov {

/// The state after the last iteration of an ADMM step, from which a rule derives the next penalty.
struct PenaltyEvidence {
  ContactValues trace, phi, lambda;
  ContactValues answered;  ///< λ + r (w − φ) before the projections: the force that w answers
};

/// Whether the penalty follows a published rule, and not the balance.
constexpr bool follows_rule(SolverOptions::Penalty penalty) {
  return adapts(penalty) && penalty != SolverOptions::Penalty::automatic;
}

/// Returns the penalty of the next step by the rule. `before`: the evidence of the step before, or null.
/// Collective.
double next_penalty(SolverOptions::Penalty rule, double r, const PenaltyEvidence& now,
                    const PenaltyEvidence* before, const Traces& traces);

}  // namespace kacanov
