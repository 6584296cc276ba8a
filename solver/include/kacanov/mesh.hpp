// SPDX-License-Identifier: BSD-3-Clause
// An owning mesh of one volume element type, with its boundary and its named parts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// Nodes of a boundary facet: tri3 2, tet4 3, tet10 6 (corners, then edges 01 12 20), hex8 4.
constexpr int nodes_per_facet(ElementType type) noexcept {
  switch (type) {
    case ElementType::tri3: return 2;
    case ElementType::tet4: return 3;
    case ElementType::tet10: return 6;
    case ElementType::hex8: return 4;
  }
  return 0;
}

/// Nodes of local facet `facet` of an element, so ordered that the normal points outwards (in 2D: the
/// body lies to the left of the directed edge).
std::span<const std::int8_t> facet_nodes(ElementType type, int facet);
int facets_per_element(ElementType type);

/// A named part of the mesh: a Gmsh physical group or a generated side.
struct Group {
  std::string name;
  int dimension = 0;                  ///< dim: elements; dim − 1: facets; below: nodes
  std::vector<std::int32_t> members;  ///< indices of elements, of `facets`, or of nodes; ascending
};

struct Mesh {
  ElementType type = ElementType::tet4;
  std::vector<double> coordinates;          ///< nodes × dim
  std::vector<std::int32_t> elements;       ///< elements × nodes_per_element, positively oriented
  std::vector<std::int64_t> node_tags;      ///< the file's numbers; empty: index + 1
  std::vector<std::int64_t> element_tags;   ///< likewise
  std::vector<std::int32_t> facets;         ///< the boundary: facets × nodes_per_facet, outwards
  std::vector<std::int32_t> facet_element;  ///< the element each facet belongs to
  std::vector<Group> groups;

  int dim() const noexcept { return dimension(type); }
  std::size_t node_count() const noexcept { return coordinates.size() / static_cast<std::size_t>(dim()); }
  std::size_t element_count() const noexcept {
    return elements.size() / static_cast<std::size_t>(nodes_per_element(type));
  }
  std::size_t facet_count() const noexcept {
    return facets.size() / static_cast<std::size_t>(nodes_per_facet(type));
  }
  MeshView view() const noexcept { return {type, coordinates, elements}; }
  std::span<const std::int32_t> facet(std::size_t f) const noexcept {
    const auto n = static_cast<std::size_t>(nodes_per_facet(type));
    return std::span(facets).subspan(f * n, n);
  }
  std::int64_t node_tag(std::size_t i) const noexcept {
    return node_tags.empty() ? static_cast<std::int64_t>(i) + 1 : node_tags[i];
  }
  std::int64_t element_tag(std::size_t i) const noexcept {
    return element_tags.empty() ? static_cast<std::int64_t>(i) + 1 : element_tags[i];
  }
};

/// Fills `facets` and `facet_element` from the elements: the facets that belong to one element only.
void find_boundary(Mesh& mesh);

/// Throws InputError naming the first inverted, degenerate (volume ≤ 1e-14 of its longest edge cubed,
/// squared in 2D) or non-finite element, a facet shared by three elements, or an unreferenced node.
void check_mesh(const Mesh& mesh);

/// Generated box [0, size]: 2D squares are cut by the diagonal from lower left to upper right, 3D cubes into
/// six tetrahedra round the diagonal from the lowest to the highest corner. Sides are named left, right,
/// front, back, bottom, top (in 2D left, right, bottom, top).
struct BoxSpec {
  std::array<double, 3> size{1, 1, 1};
  std::array<int, 3> cells{1, 1, 1};
  ElementType type = ElementType::tet4;
};
Mesh make_box(const BoxSpec& spec);

}  // namespace kacanov
