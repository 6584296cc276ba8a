// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form as one plain loop an element (theory: displacement-pressure).
#pragma once

#include <span>

#include <kacanov/reference.hpp>

namespace kacanov::reference {

/// Displacements and pressures, or forces and volume changes. `u` has nodes × dim entries, interleaved, `p`
/// one a node; those of p at mid-sides mean nothing.
template <class Real>
struct DisplacementPressure {
  std::span<Real> u, p;
};

/// y = K(g) x with K = [A Bᵀ; B −C] (overwrites y, with 0 for p at mid-sides): A the deviator's share of the
/// operator, B the volume change of every corner, C its share of mass/k0 and, where displacements are linear,
/// the stabilisation. p is the mean stress k0 tr ε, in the unit of g; `g` as in `apply`. Whoever calls has
/// checked lengths and laws. Throws std::invalid_argument for elements that are no simplices.
void apply_mixed(const Body& body, std::span<const double> g, const DisplacementPressure<const double>& x,
                 const DisplacementPressure<double>& y);

}  // namespace kacanov::reference
