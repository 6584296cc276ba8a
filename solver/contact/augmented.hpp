// SPDX-License-Identifier: BSD-3-Clause
// The augmented Lagrangian of contact and friction, as a function of the traces alone (theory:
// augmented-newton).
#pragma once

#include "contact/active_set.hpp"

namespace kacanov {

/// What contact adds to the energy of a body while multipliers λ, gaps and friction bounds stay what they
/// are: convex, with a continuous derivative, and without it nothing but a penalty. A minimiser's new
/// multipliers are those of the next round (method of multipliers), whatever r > 0 is.
class AugmentedContact {
 public:
  /// λ, gap and bound of `state`. `traces` and `state` have to outlive it.
  AugmentedContact(const Traces& traces, const ContactState& state, double r);

  double penalty() const noexcept { return r_; }
  /// Over all ranks. Collective.
  double value(const ContactValues& trace) const;
  /// Its derivative with respect to the traces, by M: the multipliers of the next round.
  ContactValues multipliers(const ContactValues& trace) const;
  /// The derivative of those: stiffness r of rows that touch and stick, slip stiffness of others.
  ActiveSet derivative(const ContactValues& trace) const;
  /// y += Cᵀ M D C x with that derivative. Returns this rank's share of what xᵀ y grows by. Collective.
  double add_stiffness(const ActiveSet& set, std::span<const double> x, std::span<double> y) const;

 private:
  /// λ_t + r Tu of a point.
  std::array<double, 2> pull(const ContactValues& trace, std::size_t i) const;

  const Traces* traces_;
  const ContactState* state_;
  double r_;
};

}  // namespace kacanov
