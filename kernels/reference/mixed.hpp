// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form as one plain loop per element (theory: displacement-pressure).
#pragma once

#include <span>

#include <kacanov/reference.hpp>

namespace kacanov::reference {

/// Displacements and pressures, or forces and volume changes. `u` has nodes × dim entries, interleaved, `p`
/// one per node; entries of p at mid-side nodes are unused.
template <class Real>
struct DisplacementPressure {
  std::span<Real> u, p;
};

/// y = K(g) x with K = [A Bᵀ; B −C] (overwrites y, with 0 for p at mid-side nodes): A is the deviatoric part
/// of the operator, B the volume change at every corner, C the lumped mass/k0 and, for linear displacements,
/// the stabilisation. p is the mean stress k0 tr ε, in the unit of g; `g` as in `apply`. The caller must have
/// checked lengths and laws. Throws std::invalid_argument for elements that are not simplices.
void apply_mixed(const Body& body, std::span<const double> g, const DisplacementPressure<const double>& x,
                 const DisplacementPressure<double>& y);

}  // namespace kacanov::reference
