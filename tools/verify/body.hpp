// SPDX-License-Identifier: BSD-3-Clause
// Internal force, stored energy and the elastic diagonal, element by element in long double.
#pragma once

#include "verify/problem.hpp"

namespace kacanov::verify {

struct BodyResponse {
  std::vector<Vec> internal;  ///< R(u), one a node
  std::vector<Vec> diagonal;  ///< of the elastic B
  std::vector<Real> size;     ///< sum of the magnitudes of the terms of R(u), per node
  Real energy = 0;
  Real most_von_mises = 0;  ///< largest mean over an element's points
  Real unknown_stress = 0;  ///< what rounding the displacement alone may change in a stress
};

/// theory: operator, b-bar, energy.
BodyResponse respond(const Problem& problem, const std::vector<Vec>& u);

}  // namespace kacanov::verify
