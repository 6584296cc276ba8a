// SPDX-License-Identifier: BSD-3-Clause
// Secant or tangent, and how long a step may be.
#pragma once

#include <optional>

#include <kacanov/model.hpp>
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// Which linearisation a semismooth Newton step takes (theory: newton): the secant while equilibrium is far
/// off, then the tangent. Where a tangent has gone too far it is trusted less.
class Linearisation {
 public:
  /// `linear`: the body has no other law; there is nothing to choose.
  Linearisation(SolverOptions::Outer outer, bool linear, const Tuning& tuning)
      : outer_(outer), linear_(linear), tuning_(tuning), reach_(tuning.first_reach) {}

  /// For a step from a state with this residual of equilibrium.
  bool takes_tangent(double equilibrium) const;
  /// Learns from a tangent step: the residual of equilibrium before and after (NaN: after a breakdown), and
  /// how much of it was taken.
  void after_tangent(double before, double after, double length = 1.0);
  void after_secant() noexcept { cut_short_ = false; }
  /// Forgets what it has learnt, for another load.
  void start_again() {
    reach_ = tuning_.first_reach;
    cut_short_ = false;
  }

  double reach() const noexcept { return reach_; }
  /// Entries of a checkpoint.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("reach", reach_);
    entry("cut_short", cut_short_);
  }

 private:
  SolverOptions::Outer outer_;
  bool linear_;
  Tuning tuning_;
  bool cut_short_ = false;  ///< the last tangent step was: the next takes the secant
  double reach_;            ///< residual of equilibrium up to which steps take the tangent
};

/// Whether a step of length `t` along δ is too long, and what to try instead; nothing if it may stay (theory:
/// damping). `work`: δ·(R(u + tδ) − R(u)), what the true force has grown by; `curvature`: δ·B δ of the linear
/// model.
std::optional<double> shorter_step(double t, double work, double curvature);

}  // namespace kacanov
