// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of background grids below the operator.
#pragma once

#include <memory>

#include "multigrid/hierarchy.hpp"

namespace kacanov {

/// Chebyshev iteration on the operator, with the displacement–pressure form on background grids below
/// (theory: background-cycle). Null if the first grid does not fit the body (GridFit). For bodies in 3D.
/// Collective.
std::unique_ptr<Multigrid::Hierarchy> make_background_hierarchy(const MultigridBody& body,
                                                                const MultigridOptions& options);

/// Average of k0/g over all points; `g`: elements × points. Collective.
double mean_contrast(const MultigridBody& body, std::span<const double> g);

}  // namespace kacanov
