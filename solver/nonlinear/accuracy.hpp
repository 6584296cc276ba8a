// SPDX-License-Identifier: BSD-3-Clause
// Accuracy of each step's solve, from the residuals at its start.
#pragma once

#include "contact/admm.hpp"
#include "contact/certificate.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// Returns tolerances, relaxation and iteration limits for the ADMM of a step (theory: inexact-solves,
/// over-relaxation; step-stop with the paper's criterion). The caller sets penalty and lumped volumes.
/// `first`: the elastic step.
AdmmOptions admm_accuracy(const SolverOptions& options, const Residuals& before, bool first,
                          const Tuning& tuning);

/// Returns the accuracy of the CG solve in a semismooth Newton step. A step that may be the last is solved
/// well below the tolerance, so that results depend on ranks and threads by no more than that.
CgOptions newton_accuracy(const SolverOptions& options, const Residuals& before, const Tuning& tuning);

/// Returns the decimal digits between the current residuals and those at which Newton steps end.
double digits_left(const SolverOptions& options, const Residuals& before, const Tuning& tuning);

/// Accuracy of a step of the method of multipliers: the unbalanced force that may remain, and its CG solves.
struct AugmentedAccuracy {
  double force = 0.0;
  CgOptions solve;
};
AugmentedAccuracy augmented_accuracy(const SolverOptions& options, const Residuals& before,
                                     const Tuning& tuning);

/// Returns the factor, 1e-4 to 1, by which residuals must be below the tolerance for the duality gap and the
/// force balance to meet it. Work of residuals is large relative to stored energy for large motions with
/// small strain; their sum is large relative to the support forces of weakly supported bodies.
double gap_share(const Certificate& certificate);

}  // namespace kacanov
