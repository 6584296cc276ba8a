// SPDX-License-Identifier: BSD-3-Clause
// A mesh as the verifier reads or makes it: elements, boundary, named groups.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "verify/shape.hpp"

namespace kacanov::verify {

using Index = std::int32_t;
using Indices = std::vector<Index>;

/// Facets of the boundary, elements, or nodes, by the dimension they have.
struct NamedGroup {
  std::string name;
  int dimension = 0;
  std::vector<Indices> cells;  ///< nodes of each; of the body's elements: their number alone
};

struct Mesh {
  Shape shape = Shape::tet4;
  std::vector<Vec> nodes;
  std::vector<std::int64_t> tags;  ///< the file's numbers of the nodes
  std::vector<Indices> made_of;  ///< nodes between which a new one of a finer mesh lies; empty: none are new
  std::vector<Indices> elements;
  std::vector<Indices> facets;  ///< the boundary, outwards
  std::vector<NamedGroup> groups;
  bool is_round = false;        ///< axisymmetric: x is the distance from the axis
  bool is_free_across = false;  ///< plane stress

  Real thickness = 1;  ///< of a plane body

  /// The length of the line that a point of the section stands for: a circle round an axis, or the thickness.
  Real depth(const Indices& cell, const Functions& at) const;
  int dim() const { return dimension(shape); }
  /// Length of the diagonal of the box round the nodes.
  Real size() const;
};

/// A generated box (user guide: meshes), with its sides as groups.
Mesh make_box(const nlohmann::json& box);
/// A Gmsh file, 2.2 or 4.1, ASCII or binary.
Mesh read_gmsh(const std::filesystem::path& file);
/// Of the case's `mesh`, with the boundary found; relative paths start at `folder`.
Mesh load_mesh(const nlohmann::json& source, const std::filesystem::path& folder);

/// What `on` selects: facets or elements by number, or nodes.
std::vector<std::size_t> select_facets(const Mesh& mesh, const nlohmann::json& on);
std::vector<std::size_t> select_elements(const Mesh& mesh, const nlohmann::json& on);
Indices select_nodes(const Mesh& mesh, const nlohmann::json& on);
/// Nodes of facets, each once, ascending.
Indices nodes_of(const Mesh& mesh, const std::vector<std::size_t>& facets);

}  // namespace kacanov::verify
