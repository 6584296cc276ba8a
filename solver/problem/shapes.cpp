// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of volume elements and facets at a point, with their derivatives.
#include "problem/shapes.hpp"

#include <span>

#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Barycentric coordinates L₀ = 1 − ξ − η − ζ, L₁ = ξ, … and their gradients.
Shapes barycentric(const Vector3& at, std::size_t corners) {
  Shapes shapes;
  shapes.value[0] = 1.0;
  for (std::size_t k = 1; k < corners; ++k) {
    shapes.value[0] -= at[k - 1];
    shapes.value[k] = at[k - 1];
    shapes.gradient[0][k - 1] = -1.0;
    shapes.gradient[k][k - 1] = 1.0;
  }
  return shapes;
}

/// Quadratic simplex from the linear one: L(2L − 1) at the corners, 4 LₐL_b at the middle of edge ab.
Shapes quadratic(const Shapes& linear, std::size_t corners,
                 std::span<const std::array<std::size_t, 2>> edges) {
  Shapes shapes;
  for (std::size_t k = 0; k < corners; ++k) {
    shapes.value[k] = linear.value[k] * (2.0 * linear.value[k] - 1.0);
    shapes.gradient[k] = (4.0 * linear.value[k] - 1.0) * linear.gradient[k];
  }
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto [a, b] = edges[k];
    shapes.value[corners + k] = 4.0 * linear.value[a] * linear.value[b];
    shapes.gradient[corners + k] =
        4.0 * linear.value[a] * linear.gradient[b] + 4.0 * linear.value[b] * linear.gradient[a];
  }
  return shapes;
}

constexpr std::array<std::array<std::size_t, 2>, 6> tetrahedron_edges{
    {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
constexpr std::array<std::array<std::size_t, 2>, 3> triangle_edges{{{0, 1}, {1, 2}, {2, 0}}};
constexpr std::array<Vector3, 8> hexahedron_corners{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

/// Products of (1 + sξ)/2 over the first `dim` coordinates: line2 apart, quad4 and hex8.
Shapes tensor(const Vector3& at, std::size_t dim) {
  Shapes shapes;
  for (std::size_t k = 0; k < (std::size_t{1} << dim); ++k) {
    const Vector3& corner = hexahedron_corners[k];
    shapes.value[k] = 1.0;
    for (std::size_t c = 0; c < dim; ++c) shapes.value[k] *= 0.5 * (1.0 + corner[c] * at[c]);
    for (std::size_t c = 0; c < dim; ++c) {
      double slope = 0.5 * corner[c];
      for (std::size_t d = 0; d < dim; ++d) {
        if (d != c) slope *= 0.5 * (1.0 + corner[d] * at[d]);
      }
      shapes.gradient[k][c] = slope;
    }
  }
  return shapes;
}

}  // namespace

Shapes element_shapes(ElementType type, const Vector3& at) {
  switch (type) {
    case ElementType::tri3: return barycentric(at, 3);
    case ElementType::tet4: return barycentric(at, 4);
    case ElementType::tet10: return quadratic(barycentric(at, 4), 4, tetrahedron_edges);
    case ElementType::hex8: return tensor(at, 3);
  }
  return {};
}

Shapes facet_shapes(ElementType type, double xi, double eta) {
  const Vector3 at{xi, eta, 0.0};
  switch (type) {
    case ElementType::tri3: return tensor(at, 1);
    case ElementType::tet4: return barycentric(at, 3);
    case ElementType::tet10: return quadratic(barycentric(at, 3), 3, triangle_edges);
    case ElementType::hex8: return tensor(at, 2);
  }
  return {};
}

}  // namespace kacanov
