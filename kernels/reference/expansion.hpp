// SPDX-License-Identifier: BSD-3-Clause
// Nodal forces and energy of constrained thermal expansion.
#pragma once

#include <span>

#include <kacanov/reference.hpp>

namespace kacanov::reference {

/// Nodal forces ∫ p div v of a pressure (overwrites f): one value per element, or 1 + corners of them, of
/// which only those at the corners are used, with linear interpolation (theory: expansion). Returns the
/// energy that the elastic body stores if it cannot expand.
double expansion_force(const Body& body, std::span<const double> pressure, std::span<double> f);

}  // namespace kacanov::reference
