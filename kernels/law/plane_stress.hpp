// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws in plane stress (theory: plane-stress): the transverse strain, and the condensed tangent.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
inline double transverse_strain(const Law& law, double xx, double yy, double xy) {
  const double plane = xx + yy;
  double z = -transverse_ratio(law.bulk, law.secant(0.0)) * plane;
  if (plane == 0.0) return 0.0;
  // The transverse stress grows with z and changes sign between the elastic solution and incompressibility.
  double low = std::min(z, -plane), high = std::max(z, -plane);
  constexpr int most_steps = 200;  // bisection alone needs fewer
  for (int step = 0; step < most_steps; ++step) {
    const double third = (plane + z) / 3.0, across = z - third;
    const double a = xx - third, b = yy - third;
    const double x = std::sqrt(a * a + b * b + across * across + 2.0 * xy * xy);
    const Moduli moduli = law.moduli(x);
    const double stress = law.bulk * (plane + z) + 2.0 * moduli.secant * across;
    (stress > 0.0 ? high : low) = z;
    const double slope = law.bulk + 4.0 / 3.0 * moduli.secant +
                         (x > 0.0 ? 2.0 * moduli.derivative / x * across * across : 0.0);
    double next = z - stress / slope;
    if (!(next > low && next < high)) next = stress == 0.0 ? z : 0.5 * (low + high);
    const double moved = std::abs(next - z);
    z = next;
    if (moved <= 2.0 * std::numeric_limits<double>::epsilon() * std::abs(z)) break;
  }
  return z;
}

/// In-plane part of the tangent's term factor · d ⊗ d, d = dev ε, after static condensation; d is (xx, yy,
/// zz, xy).
struct PlaneTerm {
  double factor = 0.0;
  double xx = 0.0, yy = 0.0, xy = 0.0;
};
inline PlaneTerm condensed(double bulk, double g, double factor, const std::array<double, 4>& d) {
  const double share = transverse_ratio(bulk, g) * d[2];
  return {factor / (1.0 + factor * d[2] * d[2] / (bulk + 4.0 / 3.0 * g)), d[0] - share, d[1] - share, d[3]};
}

}  // namespace kacanov
