// SPDX-License-Identifier: BSD-3-Clause
// Validates the boundary data that were read from a file.
#include "program/check_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

void expect(bool holds, const std::string& what) {
  if (!holds) throw InputError("the boundary's " + what);
}

void expect_below(const std::string& what, std::span<const std::int32_t> indices, std::int64_t count) {
  for (const std::int32_t index : indices)
    expect(index >= 0 && index < count,
           what + " name " + std::to_string(index) + " of " + std::to_string(count));
}

void check_groups(const Mesh& mesh) {
  const auto nodes = static_cast<std::int64_t>(mesh.node_count());
  for (const Group& group : mesh.groups) {
    expect(group.dimension >= 0 && group.dimension <= mesh.dim(), "groups are of no dimension");
    const std::int64_t members =
        group.dimension == mesh.dim()       ? static_cast<std::int64_t>(mesh.element_count())
        : group.dimension == mesh.dim() - 1 ? static_cast<std::int64_t>(mesh.facet_count())
                                            : nodes;
    expect_below("groups", group.members, members);
  }
}

}  // namespace

void check_boundary(const Problem& problem, std::span<const std::int32_t> nodes, const Part& part) {
  const Mesh& mesh = problem.mesh;
  expect(mesh.type == part.type, "element type is another than that of the part");
  const auto dim = static_cast<std::size_t>(mesh.dim());
  expect(mesh.coordinates.size() % dim == 0, "coordinates are no whole nodes");
  expect(std::all_of(mesh.coordinates.begin(), mesh.coordinates.end(),
                     [](double x) { return std::isfinite(x); }),
         "coordinates are no numbers");
  const auto count = static_cast<std::int64_t>(mesh.node_count());
  expect(mesh.node_tags.empty() || mesh.node_tags.size() == mesh.node_count(),
         "node numbers are not one a node");
  expect(mesh.facets.size() % static_cast<std::size_t>(nodes_per_facet(mesh.type)) == 0,
         "facets are no whole ones");
  expect_below("facets", mesh.facets, count);
  expect(mesh.elements.size() % static_cast<std::size_t>(nodes_per_element(mesh.type)) == 0,
         "elements are no whole ones");
  expect_below("elements", mesh.elements, count);
  expect(mesh.element_tags.empty() || mesh.element_tags.size() == mesh.element_count(),
         "element numbers are not one an element");
  // In 3D the boundary has no elements, and none are needed.
  expect(mesh.facet_element.empty() || mesh.facet_element.size() == mesh.facet_count(),
         "elements of facets are not one a facet");
  expect_below("elements of facets", mesh.facet_element, static_cast<std::int64_t>(mesh.element_count()));
  check_groups(mesh);
  expect(nodes.size() == mesh.node_count(), "nodes are not as many as its coordinates are of");
  expect_below("nodes", nodes, part.total_nodes());
  expect(static_cast<std::int64_t>(problem.contact.size()) == part.total_contact,
         "contact points are not as many as the body's");
  for (const ContactPoint& point : problem.contact)
    expect(point.node >= 0 && point.node < count, "contact points are at no node");
}

}  // namespace kacanov
