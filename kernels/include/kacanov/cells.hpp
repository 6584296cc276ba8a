// SPDX-License-Identifier: BSD-3-Clause
// The table of element types: the only place that holds facts about one element type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kacanov {

/// Element types that a body can be meshed with; the values are their numbers in the C interface.
enum class ElementType : std::uint8_t { tri3, tet4, tet10, hex8, quad4 };

/// End nodes of an edge, and its mid-side node, −1 without one.
struct CellEdge {
  std::int8_t a, b, middle = -1;
};

/// Description of a cell type: of a body, of a body's facets, or of another cell in mesh files. Nodes are in
/// Gmsh's order, corners first. Fields that do not apply to a type are empty.
struct Cell {
  std::string_view name;    ///< in kacanov and in case files
  int gmsh;                 ///< type number in Gmsh's files
  int vtk;                  ///< type number in VTK's files
  std::string_view abaqus;  ///< name as an element of a body (plane strain in 2D); empty for others
  std::string_view basix;   ///< the cell of Basix whose Lagrange element of degree `order` this is
  int dim, order, nodes, corners;
  bool simplex;  ///< reference cell with corners at 0 and the unit points; otherwise [−1, 1]^dim

  std::span<const std::array<double, 3>> reference;  ///< reference coordinates of the nodes, padded by zeros
  std::span<const CellEdge> edges;
  std::span<const std::int8_t> vtk_order;    ///< VTK's node k is node vtk_order[k] here
  std::span<const std::int8_t> basix_order;  ///< the same for Basix
  /// Flat cells: triangles that cover the cell, with its orientation.
  std::span<const std::array<std::int8_t, 3>> triangles;

  // Only for cells of bodies.
  int facet_place;                           ///< index of the facet type in cells(), −1 without facets
  std::span<const std::int8_t> facet_nodes;  ///< facets × nodes, normals outward (2D: the body to the left)
  std::span<const std::array<double, 3>> points;  ///< quadrature points, padded by zeros
  double weight;                                  ///< of each quadrature point
  bool mean_dilatation;                           ///< has a B-bar form (theory: b-bar)
  bool corner_dilatation;  ///< can average tr ε around corners (theory: displacement-pressure)
  /// Subdivision of a box: corners of the elements in the unit cell [0, 1]^dim, elements × corners.
  std::span<const std::array<std::int8_t, 3>> box;

  /// Writes the shape functions at the reference point `xi` (dim values) to `n` (nodes values).
  void (*values)(const double* xi, double* n);
  /// Writes their derivatives along the reference coordinates to `d`, nodes × dim.
  void (*gradients)(const double* xi, double* d);

  /// Type of the body's facets.
  const Cell& facet() const;
  int facets() const { return static_cast<int>(facet_nodes.size()) / facet().nodes; }
  /// Elements per box cell.
  int box_elements() const noexcept { return static_cast<int>(box.size()) / corners; }
};

/// Largest number of nodes of a cell.
inline constexpr std::size_t most_nodes = 10;
/// Largest number of nodes of a facet.
inline constexpr std::size_t most_facet_nodes = 6;

namespace cell_table {
extern const Cell* const all;  ///< bodies first, in the order of ElementType
extern const std::size_t count, bodies;
[[noreturn]] void refuse(ElementType type);
}  // namespace cell_table

/// Description of an element type. Throws std::invalid_argument for an invalid number.
inline const Cell& cell(ElementType type) {
  const auto i = static_cast<std::size_t>(type);
  if (i >= cell_table::bodies) cell_table::refuse(type);
  return cell_table::all[i];
}

inline const Cell& Cell::facet() const { return cell_table::all[facet_place]; }

/// All cell types, those of bodies first.
inline std::span<const Cell> cells() noexcept { return {cell_table::all, cell_table::count}; }

/// All types that a body can be meshed with.
std::span<const ElementType> element_types() noexcept;

/// The element type of a body meshed with `cell`, an entry of cells(); empty if a body cannot have it.
std::optional<ElementType> element_type(const Cell& cell) noexcept;
/// The type with this name; empty if there is none.
std::optional<ElementType> element_type(std::string_view name) noexcept;
/// Names of the elements for which `wanted(cell)` is true, as in "tet4, tet10 or hex8".
std::string element_names(bool (*wanted)(const Cell&));
/// Names of the elements that have a B-bar form.
std::string bbar_names();

/// Space dimension of an element: 2 or 3.
inline int dimension(ElementType type) { return cell(type).dim; }
inline int nodes_per_element(ElementType type) { return cell(type).nodes; }
/// Number of quadrature points; the secant modulus g has one value per point.
inline int points_per_element(ElementType type) { return static_cast<int>(cell(type).points.size()); }

}  // namespace kacanov
