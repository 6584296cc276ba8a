// SPDX-License-Identifier: BSD-3-Clause
// The KKT residuals of a state, relative to scales that the state itself sets.
#pragma once

#include <span>
#include <vector>

#include <kacanov/result.hpp>
#include "contact/contact_state.hpp"
#include "contact/regions.hpp"

namespace kacanov {

/// Scales of the residuals (theory: kkt): the smallest over all regions and contacts.
struct Scales {
  double force = 0.0;          ///< ‖·‖₂ of nodal forces: of the residual of equilibrium
  double contact_force = 0.0;  ///< the same of a region that has contact points
  double displacement = 0.0;   ///< max |u|
  double trace = 0.0;          ///< length: of gaps and penetrations at contact points under pressure
  /// By what a region's share of the residual counts less than that of the region with the smallest scale;
  /// empty where the body is one region.
  std::vector<double> weight;

  /// Of contact forces beside residuals with these weights.
  double contact_weight() const noexcept { return force < contact_force ? force / contact_force : 1.0; }
};

struct Residuals {
  Certificate certificate;
  Scales scales;
  double energy = 0.0;  ///< stored, as it was given
  double unbalanced =
      0.0;  ///< the residual of equilibrium beside all that acts on a region, however weak its contact
};

/// What acts on the body at a displacement besides contact; all consistent over ranks.
struct BodyForces {
  std::span<const Part::ComponentValue> load;  ///< F, ascending
  std::span<const double> internal;            ///< R(u), from the operator that is to be trusted
  double energy = 0.0;                         ///< stored
  std::span<const float> diagonal;             ///< of the elastic B
  /// The thermal part of F, and the energy of the body if it could not expand; empty: none.
  std::span<const double> expansion = {};
  double expansion_energy = 0.0;
  const StiffnessRegions* regions = nullptr;       ///< null: the body is one
  std::span<const InterfaceForce> interface = {};  ///< StiffnessRegions::interface_forces()
};

/// All relative to scales that the state itself sets, region by region and contact by contact (theory: kkt,
/// regions). Where no forces to speak of act, a share of what the softer unknowns' stiffness makes of u is
/// one, so that a body moved without strain has small residuals, and not noise over noise (theory: rounding).
/// Collective.
Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        const BodyForces& forces);

}  // namespace kacanov
