// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws by formula, and their energy by quadrature (theory: laws, energy).
#pragma once

#include <nlohmann/json.hpp>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Law {
  enum class Form { linear, logarithmic, linear_hardening, power, saturating, table, ramberg_osgood };
  Form form = Form::linear;
  bool squared = false;  ///< the formulas take x² instead of x
  bool bbar = false;
  bool mixed = false;  ///< formulation "mixed": the trace interpolates means around the corners
  Real bulk = 0, shear = 0;
  Real x0 = 0, parameter = 0;  ///< γ, n or q; n for Ramberg-Osgood
  Real share = 0;              ///< Ramberg-Osgood: plastic strain divided by elastic strain at x0
  std::vector<Real> x, s;      ///< points of a table

  /// g at the strain norm x.
  Real secant(Real strain) const;
  /// ∫₀ˣ g(s) s ds.
  Real energy(Real strain) const;
};

/// Reads a `material` entry. `may_lock`: the element type has B-bar, which is on by default for laws under
/// which it would lock.
Law read_law(const nlohmann::json& entry, bool may_lock);

}  // namespace kacanov::verify
