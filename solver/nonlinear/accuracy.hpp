// SPDX-License-Identifier: BSD-3-Clause
// How exactly a step is solved, from the residuals it starts with.
#pragma once

#include "contact/admm.hpp"
#include "contact/certificate.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// Tolerances, relaxation and caps of the ADMM in a step (theory: inexact-solves, over-relaxation; step-stop
/// with the paper's stop). Penalty and lumped volumes are left to the caller. `first`: the elastic step.
AdmmOptions admm_accuracy(const SolverOptions& options, const Residuals& before, bool first,
                          const Tuning& tuning);

/// Of the CG solve of a semismooth Newton step. What may be the last step is solved well below the tolerance,
/// so that answers do not depend on ranks or threads to more than that.
CgOptions newton_accuracy(const SolverOptions& options, const Residuals& before, const Tuning& tuning);

/// Decimal digits from the residuals of now to those that Newton steps end at.
double digits_left(const SolverOptions& options, const Residuals& before, const Tuning& tuning);

/// Of a step of the method of multipliers: the force that may be left unbalanced, and the CG solves on the
/// way.
struct AugmentedAccuracy {
  double force = 0.0;
  CgOptions solve;
};
AugmentedAccuracy augmented_accuracy(const SolverOptions& options, const Residuals& before,
                                     const Tuning& tuning);

/// How much further than the tolerance the residuals have to fall for the duality gap and the balance of
/// forces to meet it, 1e-4 to 1. Where a body moves far and strains little, their work along the motion is
/// large beside the stored energy; where little holds a body, their sum is large beside that.
double gap_share(const Certificate& certificate);

}  // namespace kacanov
