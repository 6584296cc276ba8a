// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy over the rigid motions of aggregates.
#pragma once

#include <memory>

#include "multigrid/hierarchy.hpp"

namespace kacanov {

/// Chebyshev iteration on the operator, with Galerkin matrices over the rigid motions of aggregates below
/// (theory: aggregation, over-correction). Collective.
std::unique_ptr<Multigrid::Hierarchy> make_modes_hierarchy(const MultigridBody& body,
                                                           const MultigridOptions& options);

}  // namespace kacanov
