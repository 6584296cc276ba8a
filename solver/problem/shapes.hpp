// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of a cell at a point, as spatial vectors, evaluated from the cell table.
#pragma once

#include <array>

#include <kacanov/cells.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// One entry per node, the other entries are 0; `gradient` holds derivatives with respect to reference
/// coordinates.
struct Shapes {
  std::array<double, most_nodes> value{};
  std::array<Vector3, most_nodes> gradient{};
};

/// Returns the linear cell with the same corners.
const Cell& corner_cell(const Cell& cell);

/// Evaluates the shape functions of a volume or facet cell at a reference point.
Shapes shapes_at(const Cell& cell, const Vector3& at);

}  // namespace kacanov
