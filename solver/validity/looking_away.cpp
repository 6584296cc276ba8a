// SPDX-License-Identifier: BSD-3-Clause
// Whether the facets of a contact entry look towards its obstacle.
#include <algorithm>

#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Cosine between outer normal and direction of contact below which a facet looks away: three degrees beyond
/// a right angle.
constexpr double turned = -0.05;
constexpr const char* look_away = "facets look away from the obstacle";

/// Sum of the directions in which an entry's contact points at a facet's nodes look; zero without any.
Vector3 direction_at(const ConstraintRows& contact, std::span<const std::int32_t> nodes, std::int32_t entry) {
  Vector3 sum{};
  for (const std::int32_t node : nodes) {
    auto point = std::lower_bound(contact.begin(), contact.end(), node,
                                  [](const ContactPoint& p, std::int32_t n) { return p.node < n; });
    for (; point != contact.end() && point->node == node; ++point)
      if (point->entry == entry) sum = sum + point->normal;
  }
  return sum;
}

Vector3 normal_of(const Mesh& mesh, std::int32_t facet) {
  Vector3 sum{};
  for (const Vector3& part : consistent_weights(mesh, facet).normal) sum = sum + part;
  return sum;
}

}  // namespace

void looking_away(const Problem& problem, const Model& model, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  const Selection selection(mesh);
  for (std::size_t i = 0; i < model.contact.size(); ++i) {
    const ContactEntry& entry = model.contact[i];
    // Who takes the whole boundary leaves it to the gap which of it can touch.
    if (entry.on.kind == Selector::Kind::all) continue;
    const std::string name = entry_name(entry, i);
    const std::vector<std::int32_t> facets = selection.facets(entry.on, name);
    std::size_t away = 0;
    std::int64_t first = 0;
    for (const std::int32_t f : facets) {
      const Vector3 towards = direction_at(problem.contact, mesh.facet(f), static_cast<std::int32_t>(i));
      const Vector3 normal = normal_of(mesh, f);
      if (!(dot(towards, normal) < turned * norm(towards) * norm(normal))) continue;
      const std::size_t element = mesh.facet_element[f];
      if (++away == 1) first = mesh.element_tag(element);
    }
    if (away == 0) continue;
    warnings.push_back(name + ": " + std::to_string(away) + " of its " + std::to_string(facets.size()) + " " +
                       look_away + ", the first that of element " + std::to_string(first) +
                       ": is the obstacle's normal or direction the right way round?");
  }
}

}  // namespace kacanov::validity

std::string kacanov::likely_cause(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    if (warning.find(validity::look_away) != std::string::npos) return warning;
  return {};
}
