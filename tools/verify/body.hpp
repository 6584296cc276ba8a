// SPDX-License-Identifier: BSD-3-Clause
// Internal force, stored energy and the elastic diagonal, element by element in long double.
#pragma once

#include "verify/regions.hpp"

namespace kacanov::verify {

struct BodyResponse {
  std::vector<Vec> internal;  ///< R(u), one a node
  std::vector<Vec> diagonal;  ///< of the elastic B
  /// Forces of the stresses of each region on a node, with their sign changed; one entry per node.
  std::vector<std::vector<std::pair<std::size_t, Vec>>> of_region;
  std::vector<Vec> expansion;  ///< the thermal part of the load, one entry per node
  std::vector<Real> size;      ///< sum of the magnitudes of the terms of R(u), per node
  Real energy = 0;
  Real expansion_energy = 0;  ///< what temperature would store if nothing could expand
  Real most_von_mises = 0;    ///< largest mean over an element's points
  Real unknown_stress = 0;    ///< what rounding the displacement alone may change in a stress
};

/// theory: operator, b-bar, energy.
BodyResponse respond(const Problem& problem, const Regions& regions, const std::vector<Vec>& u);

}  // namespace kacanov::verify
