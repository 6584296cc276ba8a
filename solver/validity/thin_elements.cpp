// SPDX-License-Identifier: BSD-3-Clause
// Whether elements are so thin that rounding and linear solves suffer.
#include <algorithm>
#include <array>
#include <cmath>

#include "problem/shapes.hpp"
#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

constexpr double thinnest = 1e-6;

/// Least over largest stretch of the map from the reference element, within a factor of 3: 1/(‖J⁻¹‖ ‖J‖) in
/// Frobenius norms, with the adjugate in place of the inverse so that nothing is lost where it is small.
double thinness(const Mesh& mesh, const std::int32_t* nodes, const Shapes& shapes) {
  std::array<Vector3, 3> j{};
  const std::size_t count = nodes_per_element(mesh.type);
  for (std::size_t a = 0; a < count; ++a) {
    const Vector3 x = position(mesh, nodes[a]);
    for (std::size_t c = 0; c < 3; ++c) j[c] = j[c] + shapes.gradient[a][c] * x;
  }
  if (mesh.dim() == 2) {
    const double det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    return 2.0 * det / (dot(j[0], j[0]) + dot(j[1], j[1]));
  }
  const std::array<Vector3, 3> adjugate{cross(j[1], j[2]), cross(j[2], j[0]), cross(j[0], j[1])};
  double size = 0.0, inverse = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    size += dot(j[c], j[c]);
    inverse += dot(adjugate[c], adjugate[c]);
  }
  return 3.0 * dot(j[0], adjugate[0]) / std::sqrt(size * inverse);
}

}  // namespace

void thin_elements(const Problem& problem, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  const Cell& type = cell(mesh.type);
  std::vector<Shapes> points;
  for (const auto& at : type.points) points.push_back(shapes_at(type, at));
  std::size_t thin = 0, first = 0;
  double worst = thinnest;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    double least = thinnest;
    for (const Shapes& shapes : points)
      least = std::min(least, thinness(mesh, &mesh.elements[e * type.nodes], shapes));
    if (least == thinnest) continue;
    if (thin++ == 0) first = e;
    worst = std::min(worst, least);
  }
  if (thin == 0) return;
  warnings.push_back(std::to_string(thin) + (thin == 1 ? " element is" : " elements are") +
                     " thinner than a millionth of their size, down to " + rounded(worst) +
                     ", the first element " + std::to_string(mesh.element_tag(first)) +
                     ": linear solves are slow on them or fail, and digits are lost; mesh them anew");
}

}  // namespace kacanov::validity
