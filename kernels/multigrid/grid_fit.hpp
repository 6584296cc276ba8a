// SPDX-License-Identifier: BSD-3-Clause
// Criteria for the fit of a background grid to a body.
#pragma once

#include <cstdint>
#include <span>

#include "multigrid/grid_vertices.hpp"
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

struct GridFit {
  /// Share of nodes that are not in the largest connected piece of their function's nodes, over all
  /// functions. Where elements do not connect these nodes, the function moves pieces together that can move
  /// apart. 0 for solid bodies, up to a half for two pieces.
  double cut_off = 0.0;
  /// Share of the pairs of cubes, among those that elements join, in which no function connects the two
  /// sides: cubes smaller than elements leave empty cubes between the nodes.
  double apart = 0.0;
  /// Whether cycles on the grid are better than those on aggregates.
  bool pays() const noexcept;
};

/// For the grid of `vertices`; `cell`: leaf of every local node. Collective.
GridFit grid_fit(const GridVertices& vertices, std::span<const std::int32_t> cell, const MultigridBody& body);

}  // namespace kacanov
