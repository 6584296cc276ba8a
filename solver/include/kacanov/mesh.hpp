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

/// Nodes of a boundary facet.
inline int nodes_per_facet(ElementType type) { return cell(type).facet().nodes; }
inline int facets_per_element(ElementType type) { return cell(type).facets(); }

/// A named part of the mesh: a Gmsh physical group or a generated side.
struct Group {
  std::string name;
  int dimension = 0;                  ///< dim: elements; dim − 1: facets; below: nodes
  std::vector<std::int32_t> members;  ///< indices of elements, of `facets`, or of nodes; ascending
  std::int64_t inner = 0;             ///< facets it had besides, which are not on the boundary
};

/// A number at each node, which finer meshes take over: new nodes have the mean of the corners they lie
/// between. NaN: not known.
struct NodeField {
  std::string name;
  std::vector<double> values;
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
  std::vector<NodeField> node_fields;
  std::vector<std::string> warnings;      ///< what its reader left out
  PlaneState plane = PlaneState::strain;  ///< that of the model it is put under
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

/// Fills `facets` and `facet_element` from the elements: the facets that belong to one element only.
void find_boundary(Mesh& mesh);

/// Throws InputError naming the first inverted, folded (det J < 0 at some point), degenerate (volume ≤ 1e-14
/// of its longest edge cubed, squared in 2D) or non-finite element, a facet shared by three elements, or an
/// unreferenced node.
void check_mesh(const Mesh& mesh);

/// Generated box [0, size]. Triangles cut squares by the diagonal from lower left to upper right, tetrahedra
/// cut cubes into six round the diagonal from the lowest to the highest corner. Sides are named left, right,
/// front, back, bottom, top (in 2D left, right, bottom, top).
struct BoxSpec {
  std::array<double, 3> size{1, 1, 1};
  std::array<int, 3> cells{1, 1, 1};
  ElementType type = ElementType::tet4;
};
Mesh make_box(const BoxSpec& spec);

}  // namespace kacanov
