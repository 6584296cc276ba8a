// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws in plane stress (theory: plane-stress).
#pragma once

#include <array>

#include <kacanov/law.hpp>

namespace kacanov {

/// −(transverse strain) / (in-plane tr ε) in plane stress, at the secant modulus g.
inline double transverse_ratio(double bulk, double g) {
  return (3.0 * bulk - 2.0 * g) / (3.0 * bulk + 4.0 * g);
}
/// Bulk modulus k with which τ = k tr ε I + 2 g dev ε of the in-plane strain alone gives the in-plane stress.
inline double plane_stress_bulk(double bulk, double g) {
  return 4.0 * g * (6.0 * bulk - g) / (3.0 * (3.0 * bulk + 4.0 * g));
}
/// In-plane stress of a constrained elastic body divided by its free strain, equal in all directions: E / (1
/// − ν).
inline double plane_stress_expansion(const Law& law) {
  const double shear = law.secant(0.0);
  return 2.0 * plane_stress_bulk(law.bulk, shear) + 2.0 / 3.0 * shear;
}
/// Transverse strain with zero transverse stress; strains are tensor components, not engineering shears.
double transverse_strain(const Law& law, double xx, double yy, double xy);

/// In-plane part of the tangent's term factor · d ⊗ d, d = dev ε, after static condensation; d is (xx, yy,
/// zz, xy).
struct PlaneTerm {
  double factor = 0.0;
  double xx = 0.0, yy = 0.0, xy = 0.0;
};
PlaneTerm condensed(double bulk, double g, double factor, const std::array<double, 4>& d);

}  // namespace kacanov
