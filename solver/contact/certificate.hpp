// SPDX-License-Identifier: BSD-3-Clause
// The KKT residuals of a state, relative to scales that the state itself sets.
#pragma once

#include <span>

#include <kacanov/result.hpp>
#include "contact/contact_state.hpp"

namespace kacanov {

/// What the residuals are measured by.
struct Scales {
  double force = 0.0;         ///< ‖·‖₂ of nodal forces: the largest of load, reactions, contact
  double displacement = 0.0;  ///< max |u|
  double pressure = 0.0;      ///< max |λ|, or force per contact area
};

struct Residuals {
  Certificate certificate;
  Scales scales;
  double energy = 0.0;  ///< stored, as it was given
};

/// What acts on the body at a displacement besides contact; all consistent over ranks.
struct BodyForces {
  std::span<const Part::ComponentValue> load;  ///< F, ascending
  std::span<const double> internal;            ///< R(u), from the operator that is to be trusted
  double energy = 0.0;                         ///< stored
  std::span<const float> diagonal;             ///< of the elastic B
};

/// All relative to scales that the state itself sets. Where no forces to speak of act, a share of what the
/// softer unknowns' stiffness makes of u is one, so that a body moved without strain has small residuals,
/// and not noise over noise (theory: kkt, rounding). Collective.
Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        const BodyForces& forces);

}  // namespace kacanov
