// SPDX-License-Identifier: BSD-3-Clause
// Hencky's laws where no stress acts across the plane (theory: plane-stress).
#pragma once

#include <array>

#include <kacanov/law.hpp>

namespace kacanov {

/// How much of tr ε within the plane the strain across it takes back, at the secant modulus g.
inline double transverse_ratio(double bulk, double g) {
  return (3.0 * bulk - 2.0 * g) / (3.0 * bulk + 4.0 * g);
}
/// The bulk modulus with which τ = k tr ε I + 2 g dev ε, of strains within the plane alone, is the stress
/// there.
inline double plane_stress_bulk(double bulk, double g) {
  return 4.0 * g * (6.0 * bulk - g) / (3.0 * (3.0 * bulk + 4.0 * g));
}
/// The stress within the plane of an elastic body that is kept from getting longer in it, over the strain
/// that it would have in all directions: E / (1 − ν).
inline double plane_stress_expansion(const Law& law) {
  const double shear = law.secant(0.0);
  return 2.0 * plane_stress_bulk(law.bulk, shear) + 2.0 / 3.0 * shear;
}
/// The strain across the plane that leaves no stress there; strains are components, not shears of engineers.
double transverse_strain(const Law& law, double xx, double yy, double xy);

/// What of the tangent's term factor · d ⊗ d, d = dev ε, is left within the plane, where d is (xx, yy, zz,
/// xy).
struct PlaneTerm {
  double factor = 0.0;
  double xx = 0.0, yy = 0.0, xy = 0.0;
};
PlaneTerm condensed(double bulk, double g, double factor, const std::array<double, 4>& d);

}  // namespace kacanov
