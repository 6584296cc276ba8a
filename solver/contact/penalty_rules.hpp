// SPDX-License-Identifier: BSD-3-Clause
// Published rules for one penalty of ADMM, to compare the balance with (theory: penalty-rules).
#pragma once

#include <memory>

#include <kacanov/model.hpp>
#include "contact/traces.hpp"

namespace kacanov {

/// The state after the last iteration of an ADMM step, from which a rule derives the next penalty.
struct PenaltyEvidence {
  ContactValues trace, phi, lambda;
  ContactValues answered;  ///< λ + r (w − φ) before the projections: the force that w answers
};

class PenaltyRule {
 public:
  virtual ~PenaltyRule() = default;
  /// Returns the penalty of the next step. Collective.
  virtual double next(double r, const PenaltyEvidence& now, const Traces& traces) = 0;
};

/// Returns the rule, or null if the penalty is fixed or balanced. Rules remember earlier steps, which
/// checkpoints do not hold.
std::unique_ptr<PenaltyRule> make_penalty_rule(SolverOptions::Penalty penalty);

}  // namespace kacanov
