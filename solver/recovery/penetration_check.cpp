// SPDX-License-Identifier: BSD-3-Clause
// Finds facets that penetrate an obstacle between their nodes (theory: bisection).
#include <algorithm>
#include <cmath>

#include <kacanov/discretisation.hpp>
#include "problem/faces.hpp"
#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Number of points along an edge of a facet, including its ends.
constexpr int looks = 9;

/// Returns points distributed over a facet.
std::vector<Shapes> looks_on(const Cell& facet) {
  std::vector<Shapes> all;
  const auto along = [&](int i) {
    const double share = static_cast<double>(i) / (looks - 1);
    return facet.simplex ? share : 2.0 * share - 1.0;
  };
  for (int j = 0; j < (facet.dim == 2 ? looks : 1); ++j)
    for (int i = 0; i < (facet.simplex ? looks - j : looks); ++i)
      all.push_back(shapes_at(facet, {along(i), facet.dim == 2 ? along(j) : 0.0, 0.0}));
  return all;
}

/// Returns the largest penetration of the facet, displaced by u; not positive if the facet is outside.
double deepest(const Problem& problem, std::span<const double> u, std::size_t f, const Faces& faces,
               std::span<const Shapes> points) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  const auto nodes = mesh.facet(f);
  const FacetWeights weights = consistent_weights(mesh, f);
  Vector3 outer{};
  for (std::size_t a = 0; a < nodes.size(); ++a) outer = outer + weights.normal[a];
  double most = -HUGE_VAL;
  for (const Shapes& shapes : points) {
    SurfacePoint point{{}, outer};
    Vector3 moved{};
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      point.x = point.x + shapes.value[a] * position(mesh, nodes[a]);
      for (std::size_t c = 0; c < dim; ++c)
        moved[c] += shapes.value[a] * u[static_cast<std::size_t>(nodes[a]) * dim + c];
    }
    if (const std::optional<Facing> facing = faces.between(point))
      most = std::max(most, dot(facing->normal, moved) - facing->gap);
  }
  return most;
}

}  // namespace

std::vector<std::int32_t> penetrated_elements(const Problem& problem, const Model& model,
                                              std::span<const double> u, double least) {
  const Selection selection(problem.mesh);
  std::vector<std::int32_t> entered;
  for (std::size_t i = 0; i < model.contact.size(); ++i) {
    const ContactEntry& entry = model.contact[i];
    if (entry.moves()) continue;
    const std::string path = "contact[" + std::to_string(i) + "]";
    const Faces faces(problem.mesh, entry.obstacle, path);
    const std::vector<Shapes> points = looks_on(cell(problem.mesh.type).facet());
    for (const std::int32_t f : selection.facets(entry.on, path))
      if (deepest(problem, u, static_cast<std::size_t>(f), faces, points) > least)
        entered.push_back(problem.mesh.facet_element[f]);
  }
  std::sort(entered.begin(), entered.end());
  entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
  return entered;
}

}  // namespace kacanov
