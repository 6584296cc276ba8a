// SPDX-License-Identifier: BSD-3-Clause
// Conversion of linear to quadratic elements.
#include <kacanov/raise_order.hpp>

#include <array>
#include <limits>
#include <string>

#include <kacanov/error.hpp>
#include "mesh/node_keys.hpp"

namespace kacanov {
namespace {

using MiddleNodes = std::unordered_map<std::uint64_t, std::int32_t>;

/// Returns the mid-side node of the edge from a to b, and creates it if needed.
std::int32_t middle(Mesh& mesh, MiddleNodes& middles, std::int32_t a, std::int32_t b) {
  const std::size_t dim = mesh.dim(), node = mesh.coordinates.size() / dim;
  const auto [place, fresh] = middles.try_emplace(pair_key(a, b), static_cast<std::int32_t>(node));
  if (!fresh) return place->second;
  if ((node + 1) * dim > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError("mesh.order: so many nodes have more unknowns than 32-bit indices can number");
  for (std::size_t c = 0; c < dim; ++c)
    mesh.coordinates.push_back(0.5 * (mesh.coordinates[a * dim + c] + mesh.coordinates[b * dim + c]));
  add_mean_of_fields(mesh, std::array{a, b});
  return place->second;
}

/// Returns the members that a group of the linear mesh has in the quadratic mesh.
std::vector<std::int32_t> members_of(const Group& group, const Mesh& linear, const FacetIndex& facets,
                                     const MiddleNodes& middles) {
  if (group.dimension == linear.dim() || group.dimension == 0) return group.members;
  std::vector<std::int32_t> members;
  if (group.dimension == linear.dim() - 1) {
    for (const std::int32_t f : group.members) members.push_back(facets.find(linear.facet(f)));
  } else {
    members = group.members;
    std::vector<char> in(linear.node_count(), 0);
    for (const std::int32_t n : group.members) in[n] = 1;
    for (const auto& [pair, node] : middles)
      if (in[pair >> 32] != 0 && in[pair & 0xffffffffU] != 0) members.push_back(node);
  }
  std::sort(members.begin(), members.end());
  return members;
}

}  // namespace

ElementType raised(ElementType type) {
  if (type == ElementType::tet4) return ElementType::tet10;
  throw InputError("mesh.order: 2 makes tet10 of tet4, and the mesh is of " + std::string(cell(type).name));
}

Mesh raise_order(const Mesh& linear) {
  Mesh mesh;
  mesh.type = raised(linear.type);
  mesh.coordinates = linear.coordinates;
  mesh.node_tags = linear.node_tags;
  mesh.node_fields = linear.node_fields;
  mesh.element_tags = linear.element_tags;
  const Cell& type = cell(mesh.type);
  const std::size_t corners = type.corners;
  mesh.elements.reserve(linear.element_count() * static_cast<std::size_t>(type.nodes));
  MiddleNodes middles;
  for (std::size_t e = 0; e < linear.element_count(); ++e) {
    const auto of = std::span(linear.elements).subspan(e * corners, corners);
    mesh.elements.insert(mesh.elements.end(), of.begin(), of.end());
    for (const CellEdge& edge : type.edges)
      mesh.elements.push_back(middle(mesh, middles, of[edge.a], of[edge.b]));
  }
  if (!mesh.node_tags.empty()) {
    std::int64_t next = *std::max_element(mesh.node_tags.begin(), mesh.node_tags.end());
    while (mesh.node_tags.size() < mesh.node_count()) mesh.node_tags.push_back(++next);
  }
  find_boundary(mesh);
  const FacetIndex facets(mesh);
  for (const Group& group : linear.groups)
    mesh.groups.push_back({group.name, group.dimension, members_of(group, linear, facets, middles)});
  return mesh;
}

}  // namespace kacanov
