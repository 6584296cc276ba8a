// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of volume elements and facets at a point, with their derivatives.
#pragma once

#include <array>

#include <kacanov/mesh_view.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// Reference elements: simplices have corners at the origin and the unit points, the hexahedron is
/// [−1, 1]³. `gradient` holds derivatives in reference coordinates. Up to ten nodes; the rest is 0.
struct Shapes {
  std::array<double, 10> value{};
  std::array<Vector3, 10> gradient{};
};

/// Shapes of a volume element at a reference point (ξ, η, ζ).
Shapes element_shapes(ElementType type, const Vector3& at);

/// Shapes of the facet of an element at (ξ, η): line2 and quad4 on [−1, 1], triangles on the unit one.
Shapes facet_shapes(ElementType type, double xi, double eta);

}  // namespace kacanov
