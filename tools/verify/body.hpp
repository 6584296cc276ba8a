// SPDX-License-Identifier: BSD-3-Clause
// Computes internal force, stored energy and the elastic diagonal element by element in long double.
#pragma once

#include "verify/regions.hpp"

namespace kacanov::verify {

struct BodyResponse {
  std::vector<Vec> internal;  ///< R(u), one per node
  std::vector<Vec> diagonal;  ///< diagonal of the elastic stiffness B
  /// Nodal forces of the stresses in each region, with opposite sign; one entry per node.
  std::vector<std::vector<std::pair<std::size_t, Vec>>> of_region;
  std::vector<Vec> expansion;  ///< thermal part of the load, one entry per node
  std::vector<Real> size;      ///< sum of the magnitudes of the terms of R(u), per node
  Real energy = 0;
  Real expansion_energy = 0;  ///< energy that constrained thermal expansion would store
  Real most_von_mises = 0;    ///< largest element mean of the von Mises stress
  Real unknown_stress = 0;    ///< possible error of a stress if only the displacement is rounded
};

/// Returns the response to u (theory: operator, b-bar, energy).
BodyResponse respond(const Problem& problem, const Regions& regions, const std::vector<Vec>& u);

}  // namespace kacanov::verify
