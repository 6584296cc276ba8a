// SPDX-License-Identifier: BSD-3-Clause
// Computes internal force, stored energy and the elastic diagonal element by element in long double.
#pragma once

#include "verify/regions.hpp"

namespace kacanov::verify {

/// What the elements of one region contribute to a node.
struct RegionForce {
  std::size_t region = 0;
  Vec force{};       ///< nodal force of the stresses, with opposite sign
  Vec diagonal{};    ///< of the elastic stiffness
  Real largest = 0;  ///< max |u| of these elements
};

struct BodyResponse {
  std::vector<Vec> internal;                        ///< R(u), one per node
  std::vector<Vec> diagonal;                        ///< diagonal of the elastic stiffness B
  std::vector<std::vector<RegionForce>> of_region;  ///< one list per node
  std::vector<Vec> expansion;                       ///< thermal part of the load, one entry per node
  std::vector<Real> size;                           ///< sum of the magnitudes of the terms of R(u), per node
  Real energy = 0;
  Real expansion_energy = 0;  ///< energy that constrained thermal expansion would store
  Real most_von_mises = 0;    ///< largest element mean of the von Mises stress
  Real unknown_stress = 0;    ///< possible error of a stress if only the displacement is rounded
};

/// Returns the response to u (theory: operator, b-bar, energy).
BodyResponse respond(const Problem& problem, const Regions& regions, const std::vector<Vec>& u);

}  // namespace kacanov::verify
