// SPDX-License-Identifier: BSD-3-Clause
// The KKT residuals of a state, relative to scales that the state itself sets.
#pragma once

#include <span>

#include <kacanov/result.hpp>
#include "contact/admm.hpp"

namespace kacanov {

/// What the residuals are measured by.
struct Scales {
  double force = 0.0;         ///< ‖·‖₂ of nodal forces: the largest of load, reactions, contact
  double displacement = 0.0;  ///< max |ω|
  double pressure = 0.0;      ///< max |λ|, or force per contact area
};

struct Residuals {
  Certificate certificate;
  Scales scales;
  double energy = 0.0;  ///< stored, as it was given
};

/// `internal` is R(ω) from the operator that is to be trusted, consistent over ranks; `energy` the stored
/// energy at ω; `diagonal` that of the elastic B, consistent: forces of 10⁻⁹ ‖diagonal ∘ ω‖ and energies
/// likewise are rounding, so that a body moved without strain has small residuals, and not noise over noise.
Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        std::span<const double> internal, double energy, std::span<const float> diagonal);

}  // namespace kacanov
