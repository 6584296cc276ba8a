// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of a cell at a point as vectors in space, from the table of cells.
#pragma once

#include <array>

#include <kacanov/cells.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// One entry a node; `gradient` holds derivatives along the reference coordinates. The rest is 0.
struct Shapes {
  std::array<double, most_nodes> value{};
  std::array<Vector3, most_nodes> gradient{};
};

/// The linear cell of the same corners.
const Cell& corner_cell(const Cell& cell);

/// Shapes of a cell, of a body or of a facet, at a reference point.
Shapes shapes_at(const Cell& cell, const Vector3& at);

}  // namespace kacanov
