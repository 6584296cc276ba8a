// SPDX-License-Identifier: BSD-3-Clause
// Mesh of the verifier, read or generated: elements, boundary, named groups.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "verify/shape.hpp"

namespace kacanov::verify {

using Index = std::int32_t;
using Indices = std::vector<Index>;

/// A named group of boundary facets, elements, or nodes, according to its dimension.
struct NamedGroup {
  std::string name;
  int dimension = 0;
  std::vector<Indices> cells;  ///< nodes of each member; element groups: the element number only
};

struct Mesh {
  Shape shape = Shape::tet4;
  std::vector<Vec> nodes;
  std::vector<std::int64_t> tags;  ///< node numbers of the file
  std::vector<Indices> made_of;    ///< parent nodes of each node added by refinement; empty: no new nodes
  std::vector<Indices> elements;
  std::vector<Indices> facets;  ///< boundary facets, oriented outwards
  std::vector<NamedGroup> groups;
  bool is_round = false;        ///< axisymmetric: x is the distance from the axis
  bool is_free_across = false;  ///< plane stress

  Real thickness = 1;  ///< of a plane body

  /// Returns the length in the third direction at a point of the section: the circumference around the axis,
  /// or the thickness.
  Real depth(const Indices& cell, const Functions& at) const;
  int dim() const { return dimension(shape); }
  /// Diagonal of the bounding box of the nodes.
  Real size() const;
};

/// Generates a box (user guide: meshes) with its sides as groups.
Mesh make_box(const nlohmann::json& box);
/// Reads a Gmsh file, 2.2 or 4.1, ASCII or binary.
Mesh read_gmsh(const std::filesystem::path& file);
/// Loads the case's `mesh` and finds its boundary; relative paths start at `folder`.
Mesh load_mesh(const nlohmann::json& source, const std::filesystem::path& folder);

/// Returns the selection of `on`: facet or element indices, or nodes.
std::vector<std::size_t> select_facets(const Mesh& mesh, const nlohmann::json& on);
std::vector<std::size_t> select_elements(const Mesh& mesh, const nlohmann::json& on);
Indices select_nodes(const Mesh& mesh, const nlohmann::json& on);
/// Returns the nodes of the facets, each once, in ascending order.
Indices nodes_of(const Mesh& mesh, const std::vector<std::size_t>& facets);

}  // namespace kacanov::verify
