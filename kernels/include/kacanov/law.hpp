// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws: secant shear modulus g, its derivative and its energy.
#pragma once

#include <cstdint>
#include <vector>

namespace kacanov {

/// tau = k0 tr(eps) I + 2 g(x) dev eps, x = ‖dev eps‖ (Frobenius). `paper` equation (34) is
/// `logarithmic`. Every member function takes the norm x ≥ 0, whatever `argument` is.
struct Law {
  enum class Kind : std::uint8_t { linear, logarithmic, linear_hardening, power, saturating, table };
  enum class Argument : std::uint8_t { norm, squared };

  Kind kind = Kind::linear;
  Argument argument = Argument::norm;    ///< what the formula of g is fed with: x or x²
  double bulk = 0.0;                     ///< k0
  double shear = 0.0;                    ///< mu = g(0)
  double x0 = 0.0;                       ///< yield strain, compared with the argument
  double gamma = 0.0;                    ///< linear_hardening
  double n = 1.0;                        ///< power
  double q = 1.0;                        ///< saturating
  bool mean_dilatation = false;          ///< hex8 only: k0 sees the element's mean of tr(eps) (B-bar)
  std::vector<double> table_x, table_s;  ///< table: strain norms and ‖dev tau‖, from (0, 0)

  struct Moduli {
    double secant, derivative;
  };
  /// g and dg/dx at once.
  Moduli moduli(double x) const;
  /// Secant modulus g.
  double secant(double x) const;
  /// dg/dx with respect to the norm x.
  double secant_derivative(double x) const;
  /// G(x) = ∫₀ˣ g(s) s ds; the energy density of a point is k0/2 tr² + 2 G(x).
  double energy(double x) const;
  /// True where stress falls with strain, d(g x)/dx < 0 (possible with the squared argument only).
  bool softens(double x) const;
  /// True beyond the yield strain.
  bool plastic(double x) const;
};

/// k0 = E / (3 (1 − 2 nu)), mu = E / (2 (1 + nu)).
Law elastic_law(double young, double poisson);

}  // namespace kacanov
