// SPDX-License-Identifier: BSD-3-Clause
// Which contact points touch, stick and slip in a primal–dual active set (semismooth Newton) step.
#pragma once

#include "contact/admm.hpp"
#include "contact/trace_rows.hpp"

namespace kacanov {

/// What each contact point does in the step: decided by λ + c(Cu − ρ), as in the projections of ADMM.
struct ActiveSet {
  std::vector<TraceChoice> held;  ///< normal: touches; tangential: sticks
  Vector slip_force;              ///< points × 2: ψ ŝ where it slips, without what follows the pressure
  Vector slip_stiffness;          ///< points: k of λ_t = (ψ + μ_f λ_n) ŝ + k (I − ŝŝᵀ) Tu, 0 in 2D
  Vector slip_direction;          ///< points × 2: ŝ
  Vector coulomb;                 ///< points: μ_f where it slips under pressure, else 0

  /// Nothing held, and nothing slips.
  explicit ActiveSet(std::size_t points = 0)
      : held(points),
        slip_force(2 * points, 0.0),
        slip_stiffness(points, 0.0),
        slip_direction(2 * points, 0.0),
        coulomb(points, 0.0) {}
};

/// c is a penalty like ADMM's; any positive value has the same fixed points.
ActiveSet decide(const Traces& traces, const ContactState& state, double c);

}  // namespace kacanov
