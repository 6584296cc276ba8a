// SPDX-License-Identifier: BSD-3-Clause
// Strain and stress at one point, as the reference computes them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <kacanov/law.hpp>

namespace kacanov::reference {

/// Symmetric 3×3 tensor, components (not engineering shears) xx yy zz xy yz zx.
using Sym = std::array<double, 6>;

/// Component (i, j) of the tensor; plane strain uses the upper left 2×2 block.
inline double component(const Sym& s, int i, int j) {
  constexpr int index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  return s[index[i][j]];
}

inline double inner(const Sym& a, const Sym& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

struct Strain {
  double trace = 0.0;
  double square = 0.0;  ///< weighted mean square of the corner averages that give `trace`; otherwise unused
  Sym dev{};
  double norm() const { return std::sqrt(inner(dev, dev)); }
};

/// τ = k0 tr ε I + 2 g dev ε.
inline Sym stress(const Law& law, double g, const Strain& strain) {
  Sym tau;
  for (std::size_t i = 0; i < 6; ++i)
    tau[i] = 2.0 * g * strain.dev[i] + (i < 3 ? law.bulk * strain.trace : 0.0);
  return tau;
}

/// ∂u_i/∂x_k.
using Gradient = std::array<std::array<double, 3>, 3>;

/// Largest magnitude of an eigenvalue of the symmetric part, by Cardano's formulas.
inline double largest_principal(const Gradient& h) {
  const double mean = (h[0][0] + h[1][1] + h[2][2]) / 3.0;
  const double a = h[0][0] - mean, b = h[1][1] - mean, c = h[2][2] - mean;
  const double d = 0.5 * (h[0][1] + h[1][0]), e = 0.5 * (h[1][2] + h[2][1]), f = 0.5 * (h[2][0] + h[0][2]);
  const double p = std::sqrt((a * a + b * b + c * c + 2.0 * (d * d + e * e + f * f)) / 6.0);
  if (!(p > 0.0)) return std::abs(mean);
  const double det = a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
  const double angle = std::acos(std::clamp(0.5 * det / (p * p * p), -1.0, 1.0)) / 3.0;
  const double third = 2.0 * std::numbers::pi / 3.0;
  return std::max(std::abs(mean + 2.0 * p * std::cos(angle)),
                  std::abs(mean + 2.0 * p * std::cos(angle + third)));
}

inline double rotation_angle(const Gradient& h) {
  return 0.5 * std::hypot(h[2][1] - h[1][2], h[0][2] - h[2][0], h[1][0] - h[0][1]);
}

/// Adds the transverse strain z.
inline Strain stretched(Strain strain, double z) {
  strain.trace += z;
  strain.dev[0] -= z / 3.0, strain.dev[1] -= z / 3.0, strain.dev[2] += 2.0 / 3.0 * z;
  return strain;
}

/// Tangent stress of the increment `strain` at the strain `at`.
inline Sym tangent_stress(const Law& law, const Moduli& moduli, const Strain& at, const Strain& strain) {
  Sym tau = stress(law, moduli.secant, strain);
  const double slope = moduli.derivative;
  if (slope == 0.0) return tau;  // also the limit x → 0 of every law
  const double factor = 2.0 * slope / at.norm() * inner(at.dev, strain.dev);
  for (std::size_t i = 0; i < 6; ++i) tau[i] += factor * at.dev[i];
  return tau;
}

}  // namespace kacanov::reference
