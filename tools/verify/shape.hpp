// SPDX-License-Identifier: BSD-3-Clause
// Shape functions, quadrature rules and facets of the elements, as theory: elements and loads have them.
#pragma once

#include <string>

#include "verify/real.hpp"

namespace kacanov::verify {

/// Nodes are in Gmsh's order.
enum class Shape { line2, tri3, tri6, quad4, tet4, tet10, hex8 };

int dimension(Shape shape);
int node_count(Shape shape);
int corner_count(Shape shape);

/// Value and gradient in reference coordinates of every shape function at a point. Simplices have the corners
/// 0 and the unit points, the others ±1.
struct Functions {
  std::vector<Real> value;
  std::vector<Vec> gradient;
};
Functions functions(Shape shape, const Vec& at);

struct QuadraturePoint {
  Vec at{};
  Real weight = 0;
};
/// The rule that stiffness is integrated with (theory: elements).
std::vector<QuadraturePoint> stiffness_rule(Shape shape);
/// The rule that loads and areas are integrated with (theory: loads).
/// `finer`: of products with a linear function.
std::vector<QuadraturePoint> load_rule(Shape shape, bool finer = false);

/// The linear shape of the same corners.
Shape corner_shape(Shape shape);

/// What the facets of a body's element are, and the places of their nodes in the element; outwards.
Shape facet_shape(Shape body);
std::vector<std::vector<int>> facets(Shape body);

}  // namespace kacanov::verify
