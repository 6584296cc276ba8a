// SPDX-License-Identifier: BSD-3-Clause
// The active set of a primal–dual active set (semismooth Newton) step: contact points that touch, stick or
// slip.
#pragma once

#include "contact/admm.hpp"
#include "contact/trace_rows.hpp"

namespace kacanov {

/// State of each contact point in the step, decided from λ + c(Cu − ρ) as in the projections of ADMM.
struct ActiveSet {
  std::vector<TraceChoice> held;  ///< normal: touches; tangential: sticks
  Vector slip_force;      ///< points × 2: ψ ŝ at slipping points, without the pressure-dependent part
  Vector slip_stiffness;  ///< points: k of λ_t = (ψ + μ_f λ_n) ŝ + k (I − ŝŝᵀ) Tu, 0 in 2D
  Vector slip_direction;  ///< points × 2: ŝ
  Vector coulomb;         ///< points: μ_f at points that slip under pressure, else 0

  /// Empty active set: no row is held and no point slips.
  explicit ActiveSet(std::size_t points = 0)
      : held(points),
        slip_force(2 * points, 0.0),
        slip_stiffness(points, 0.0),
        slip_direction(2 * points, 0.0),
        coulomb(points, 0.0) {}
};

/// Decides the active set. c is a penalty as in ADMM; all positive values have the same fixed points.
ActiveSet decide(const Traces& traces, const ContactState& state, double c);

}  // namespace kacanov
