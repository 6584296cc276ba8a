// SPDX-License-Identifier: BSD-3-Clause
// Whether a background grid fits a body.
#pragma once

#include <cstdint>
#include <span>

#include "multigrid/grid_vertices.hpp"
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

struct GridFit {
  /// Where the elements between the nodes that a function moves leave these in several pieces, it moves as
  /// one what may go apart: the share of the nodes that are not in their function's largest piece, over all
  /// functions; 0 for solid bodies, up to a half for one in two.
  double cut_off = 0.0;
  /// Where cubes are smaller than elements, there are some between their nodes that have none, and no
  /// function joins what is on both sides: the share of such pairs of cubes among those that elements join.
  double apart = 0.0;
  /// Whether cycles on the grid are better than those on modes of aggregates.
  bool pays() const noexcept;
};

/// Of the grid of `vertices`; `cell`: its leaf of every local node. Collective.
GridFit grid_fit(const GridVertices& vertices, std::span<const std::int32_t> cell, const MultigridBody& body);

}  // namespace kacanov
