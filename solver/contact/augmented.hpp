// SPDX-License-Identifier: BSD-3-Clause
// The augmented Lagrangian of contact and friction as a function of the traces (theory: augmented-newton).
#pragma once

#include "contact/active_set.hpp"

namespace kacanov {

/// Contribution of contact to the energy at fixed multipliers λ, gaps and friction bounds: convex, with a
/// continuous derivative; for λ = 0 a pure penalty. The multipliers at its minimiser start the next iteration
/// of the method of multipliers, which converges for any r > 0.
class AugmentedContact {
 public:
  /// Uses λ, gap and bound of `state`. `traces` and `state` must outlive it.
  AugmentedContact(const Traces& traces, const ContactState& state, double r);

  double penalty() const noexcept { return r_; }
  /// Returns its value over all ranks. Collective.
  double value(const ContactValues& trace) const;
  /// Returns its derivative with respect to the traces, divided by M: the multipliers of the next iteration.
  ContactValues multipliers(const ContactValues& trace) const;
  /// Returns their derivative: stiffness r of rows that touch or stick, slip stiffness of the others.
  ActiveSet derivative(const ContactValues& trace) const;
  /// y += Cᵀ M D C x with this derivative D. Returns this rank's share of the increase of xᵀ y. Collective.
  double add_stiffness(const ActiveSet& set, std::span<const double> x, std::span<double> y) const;

 private:
  /// Returns λ_t + r Tu of a point.
  std::array<double, 2> pull(const ContactValues& trace, std::size_t i) const;

  const Traces* traces_;
  const ContactState* state_;
  double r_;
};

}  // namespace kacanov
