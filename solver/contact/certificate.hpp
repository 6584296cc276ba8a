// SPDX-License-Identifier: BSD-3-Clause
// KKT residuals of a state, relative to scales computed from that state.
#pragma once

#include <span>
#include <vector>

#include <kacanov/result.hpp>
#include "contact/contact_state.hpp"
#include "contact/regions.hpp"

namespace kacanov {

/// Scales of the residuals (theory: kkt): the minima over all regions and contact entries.
struct Scales {
  double force = 0.0;          ///< ‖·‖₂ of nodal forces, for the equilibrium residual
  double contact_force = 0.0;  ///< the same for regions with contact points
  double displacement = 0.0;   ///< max |u|
  double trace = 0.0;          ///< a length, for gaps and penetrations at contact points under pressure
  /// Weight of a region's residual relative to that of the region with the smallest scale; empty for a body
  /// of one region.
  std::vector<double> weight;

  /// Returns the weight of contact forces relative to residuals with these weights.
  double contact_weight() const noexcept { return force < contact_force ? force / contact_force : 1.0; }
};

struct Residuals {
  Certificate certificate;
  Scales scales;
  double energy = 0.0;  ///< stored energy, as given
  /// Equilibrium residual relative to all forces on a region, however small its contact force.
  double unbalanced = 0.0;
};

/// Forces on the body at a displacement, except contact; all consistent over ranks.
struct BodyForces {
  std::span<const Part::ComponentValue> load;  ///< F, ascending
  std::span<const double> internal;            ///< R(u), from the trusted operator
  double energy = 0.0;                         ///< stored
  std::span<const float> diagonal;             ///< of the elastic B
  /// Thermal part of F, and the energy of the body with fully constrained expansion; empty: none.
  std::span<const double> expansion = {};
  double expansion_energy = 0.0;
  const StiffnessRegions* regions = nullptr;       ///< null: the body is one region
  std::span<const InterfaceForce> interface = {};  ///< StiffnessRegions::interface_forces()
  double tolerance = 1e-6;                         ///< η of the run
};

/// Computes the residuals relative to scales of the state, per region and contact entry (theory: kkt,
/// regions). Without significant forces the scale is a share of the softer unknowns' stiffness times u, so
/// that rigid motion gives small residuals, not ratios of rounding errors (theory: rounding). Collective.
Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        const BodyForces& forces);

}  // namespace kacanov
