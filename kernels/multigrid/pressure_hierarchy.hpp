// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy for bodies whose volume change is averaged.
#pragma once

#include <memory>

#include "multigrid/hierarchy.hpp"

namespace kacanov {

/// A cycle on displacements and pressures that returns the displacements (theory: pressure-multigrid). Null
/// if elements average over themselves and the first grid does not fit the body. For bodies in 3D with a law
/// that averages. Collective.
std::unique_ptr<Multigrid::Hierarchy> make_pressure_hierarchy(const MultigridBody& body,
                                                              const MultigridOptions& options);

/// Largest k0/g of elements that average; `g`: elements × points. Collective.
double pressure_contrast(const MultigridBody& body, std::span<const double> g);

}  // namespace kacanov
