// SPDX-License-Identifier: BSD-3-Clause
// Hencky's laws by their formulas, and their energy by quadrature (theory: laws, energy).
#pragma once

#include <nlohmann/json.hpp>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Law {
  enum class Form { linear, logarithmic, linear_hardening, power, saturating, table, ramberg_osgood };
  Form form = Form::linear;
  bool squared = false;  ///< the formulas are fed with x² in place of x
  bool bbar = false;
  bool mixed = false;  ///< by word; with tet10: the trace is that of means round the corners
  Real bulk = 0, shear = 0;
  Real x0 = 0, parameter = 0;  ///< γ, n or q; of Ramberg and Osgood n
  Real share = 0;              ///< of Ramberg and Osgood: plastic over elastic strain at x0
  std::vector<Real> x, s;      ///< of a table

  /// g at the strain norm x.
  Real secant(Real strain) const;
  /// ∫₀ˣ g(s) s ds.
  Real energy(Real strain) const;
};

/// An entry of `material`. `may_lock`: on elements that have B-bar, which is on by itself where they would
/// lock.
Law read_law(const nlohmann::json& entry, bool may_lock);

}  // namespace kacanov::verify
