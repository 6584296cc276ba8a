// SPDX-License-Identifier: BSD-3-Clause
// Shape functions, quadrature rules and facets of the elements (theory: elements, loads).
#pragma once

#include <string>

#include "verify/real.hpp"

namespace kacanov::verify {

/// Nodes are in Gmsh's order.
enum class Shape { line2, tri3, tri6, quad4, tet4, tet10, hex8 };

int dimension(Shape shape);
int node_count(Shape shape);
int corner_count(Shape shape);

/// Values and reference gradients of all shape functions at a point. Corners: the origin and unit points for
/// simplices, ±1 for the others.
struct Functions {
  std::vector<Real> value;
  std::vector<Vec> gradient;
};
Functions functions(Shape shape, const Vec& at);

struct QuadraturePoint {
  Vec at{};
  Real weight = 0;
};
/// Returns the quadrature rule of the stiffness (theory: elements).
std::vector<QuadraturePoint> stiffness_rule(Shape shape);
/// Returns the quadrature rule of loads and areas (theory: loads). `finer`: exact also after multiplication
/// by a linear function.
std::vector<QuadraturePoint> load_rule(Shape shape, bool finer = false);

/// Returns the linear shape with the same corners.
Shape corner_shape(Shape shape);

/// Returns the shape of a body element's facets, and their node places within the element, oriented outwards.
Shape facet_shape(Shape body);
std::vector<std::vector<int>> facets(Shape body);

}  // namespace kacanov::verify
