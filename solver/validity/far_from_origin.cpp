// SPDX-License-Identifier: BSD-3-Clause
// Whether the body is so far from the origin that double precision does not hold its shape.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "operator/element_maps.hpp"
#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Share of an element's size that rounding its coordinates may move a node by.
constexpr double unnoticed = 1e-9;

double farthest_coordinate(const Mesh& mesh, std::size_t element) {
  const std::size_t count = nodes_per_element(mesh.type);
  double far = 0.0;
  for (const std::int32_t node : std::span(mesh.elements).subspan(element * count, count))
    for (const double x : position(mesh, node)) far = std::max(far, std::abs(x));
  return far;
}

}  // namespace

void far_from_origin(const Problem& problem, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  double worst = 0.0;
  std::size_t element = 0;
  visit_element_maps(mesh.view(), [&](std::size_t first, std::span<const ElementMap> maps) {
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const double size = std::pow(maps[k].volume, 1.0 / mesh.dim());
      const double moved =
          0.5 * std::numeric_limits<double>::epsilon() * farthest_coordinate(mesh, first + k);
      if (!(moved > worst * size)) continue;
      worst = moved / size;
      element = first + k;
    }
  });
  if (!(worst > unnoticed)) return;
  warnings.push_back(
      "the body lies so far from the origin that reading its coordinates in double precision "
      "has moved nodes by up to " +
      rounded(worst) + " of the size of an element, first at element " +
      std::to_string(mesh.element_tag(element)) +
      ": the numbers are those of the body as it was read; shift it to the origin");
}

}  // namespace kacanov::validity
