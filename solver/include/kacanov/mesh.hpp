// SPDX-License-Identifier: BSD-3-Clause
// An owning mesh of one volume element type, with its boundary and its named groups.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// Number of nodes of a boundary facet.
inline int nodes_per_facet(ElementType type) { return cell(type).facet().nodes; }
inline int facets_per_element(ElementType type) { return cell(type).facets(); }

/// A named part of the mesh: a Gmsh physical group or a generated side.
struct Group {
  std::string name;
  int dimension = 0;                  ///< dim: elements; dim − 1: facets; below: nodes
  std::vector<std::int32_t> members;  ///< indices of elements, of `facets`, or of nodes; ascending
  std::int64_t inner = 0;  ///< number of its facets that are not on the boundary, dropped from `members`
};

/// A scalar field at the nodes, which refinement interpolates: new nodes get the mean of the corners between
/// which they lie. NaN: unknown.
struct NodeField {
  std::string name;
  std::vector<double> values;
};

struct Mesh {
  ElementType type = ElementType::tet4;
  std::vector<double> coordinates;          ///< nodes × dim
  std::vector<std::int32_t> elements;       ///< elements × nodes_per_element, positively oriented
  std::vector<std::int64_t> node_tags;      ///< node numbers of the file; empty: index + 1
  std::vector<std::int64_t> element_tags;   ///< likewise
  std::vector<std::int32_t> facets;         ///< the boundary: facets × nodes_per_facet, outwards
  std::vector<std::int32_t> facet_element;  ///< element of each facet
  std::vector<Group> groups;
  std::vector<NodeField> node_fields;
  std::vector<std::string> warnings;      ///< what the mesh reader ignored
  PlaneState plane = PlaneState::strain;  ///< set from the model
  double thickness = 1.0;                 ///< likewise

  int dim() const { return dimension(type); }
  std::size_t node_count() const { return coordinates.size() / static_cast<std::size_t>(dim()); }
  std::size_t element_count() const {
    return elements.size() / static_cast<std::size_t>(nodes_per_element(type));
  }
  std::size_t facet_count() const { return facets.size() / static_cast<std::size_t>(nodes_per_facet(type)); }
  MeshView view() const noexcept { return {type, coordinates, elements, plane}; }
  std::span<const std::int32_t> facet(std::size_t f) const {
    const std::size_t n = nodes_per_facet(type);
    return std::span(facets).subspan(f * n, n);
  }
  std::int64_t node_tag(std::size_t i) const noexcept {
    return node_tags.empty() ? static_cast<std::int64_t>(i) + 1 : node_tags[i];
  }
  std::int64_t element_tag(std::size_t i) const noexcept {
    return element_tags.empty() ? static_cast<std::int64_t>(i) + 1 : element_tags[i];
  }
};

/// Fills `facets` and `facet_element`: the facets that belong to exactly one element.
void find_boundary(Mesh& mesh);

/// Throws InputError that names the first inverted, folded (det J < 0 at some point), degenerate (volume ≤
/// 1e-14 of its longest edge cubed, squared in 2D) or non-finite element, a facet shared by three elements,
/// or an unreferenced node.
void check_mesh(const Mesh& mesh);

/// Components of elements connected by shared nodes, numbered in the order of their first elements.
struct MeshPieces {
  std::int32_t count = 0;
  std::vector<std::int32_t> of_node;  ///< −1: node of no element
};
MeshPieces connected_pieces(const Mesh& mesh);

/// A generated box [0, size]. Triangles split squares along the diagonal from lower left to upper right; six
/// tetrahedra fill each cube around the diagonal from the lowest to the highest corner. Sides are named left,
/// right, front, back, bottom, top (in 2D left, right, bottom, top).
struct BoxSpec {
  std::array<double, 3> size{1, 1, 1};
  std::array<int, 3> cells{1, 1, 1};
  ElementType type = ElementType::tet4;
};
Mesh make_box(const BoxSpec& spec);

}  // namespace kacanov
