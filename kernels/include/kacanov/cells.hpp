// SPDX-License-Identifier: BSD-3-Clause
// The table of element types: whatever anybody has to know about one of them stands here and nowhere else.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kacanov {

/// Elements that a body can be made of, with their numbers in the C interface.
enum class ElementType : std::uint8_t { tri3, tet4, tet10, hex8, quad4 };

/// Ends of an edge, and the node in the middle of it, −1 without one.
struct CellEdge {
  std::int8_t a, b, middle = -1;
};

/// Facts of one type of cell: of a body, of a body's facet, or of something else that mesh files hold. Nodes
/// are in Gmsh's order, corners first. What a type has no use for is empty.
struct Cell {
  std::string_view name;    ///< here and in case files
  int gmsh;                 ///< type number in Gmsh's files
  int vtk;                  ///< type number in VTK's files
  std::string_view abaqus;  ///< as an element of a body (plane strain in 2D); empty for others
  std::string_view basix;   ///< the cell of Basix whose Lagrange element of degree `order` this is
  int dim, order, nodes, corners;
  bool simplex;  ///< reference cell with corners at 0 and the unit points; otherwise [−1, 1]^dim

  std::span<const std::array<double, 3>> reference;  ///< reference coordinates of the nodes, padded by zeros
  std::span<const CellEdge> edges;
  std::span<const std::int8_t> vtk_order;    ///< VTK's node k is ours of number vtk_order[k]
  std::span<const std::int8_t> basix_order;  ///< likewise
  /// Flat cells: triangles that cover it, turning as it does.
  std::span<const std::array<std::int8_t, 3>> triangles;

  // Bodies only.
  int facet_place;                           ///< of the type of its facets among cells(), −1 without
  std::span<const std::int8_t> facet_nodes;  ///< facets × nodes, normals outwards (2D: the body to the left)
  std::span<const std::array<double, 3>> points;  ///< quadrature points, padded by zeros
  double weight;                                  ///< of each point
  bool mean_dilatation;                           ///< has a B-bar form (theory: b-bar)
  bool corner_dilatation;  ///< can average tr ε round corners (theory: displacement-pressure)
  /// How a box is cut: corners of the elements of the unit cell [0, 1]^dim, elements × corners.
  std::span<const std::array<std::int8_t, 3>> box;

  /// Shape functions at the reference point `xi` (dim values) into `n` (nodes values).
  void (*values)(const double* xi, double* n);
  /// Their derivatives along the reference coordinates into `d`, nodes × dim.
  void (*gradients)(const double* xi, double* d);

  /// Type of a body's facets.
  const Cell& facet() const;
  int facets() const { return static_cast<int>(facet_nodes.size()) / facet().nodes; }
  /// Elements a box cell is cut into.
  int box_elements() const noexcept { return static_cast<int>(box.size()) / corners; }
};

/// No cell has more nodes.
inline constexpr std::size_t most_nodes = 10;
/// No facet has more nodes.
inline constexpr std::size_t most_facet_nodes = 6;

namespace cell_table {
extern const Cell* const all;  ///< bodies first, in the order of ElementType
extern const std::size_t count, bodies;
[[noreturn]] void refuse(ElementType type);
}  // namespace cell_table

/// Facts of an element type. Throws std::invalid_argument for a number that is none.
inline const Cell& cell(ElementType type) {
  const auto i = static_cast<std::size_t>(type);
  if (i >= cell_table::bodies) cell_table::refuse(type);
  return cell_table::all[i];
}

inline const Cell& Cell::facet() const { return cell_table::all[facet_place]; }

/// All cells there are: those of bodies first.
inline std::span<const Cell> cells() noexcept { return {cell_table::all, cell_table::count}; }

/// All types a body can be made of.
std::span<const ElementType> element_types() noexcept;

/// The type a body made of `cell`, an entry of cells(), has; nothing if none can be.
std::optional<ElementType> element_type(const Cell& cell) noexcept;
/// The type of this name; nothing if there is none.
std::optional<ElementType> element_type(std::string_view name) noexcept;
/// Names of the elements that `wanted(cell)` holds for, as in "tet4, tet10 or hex8".
std::string element_names(bool (*wanted)(const Cell&));
/// Names of those that have a B-bar form.
std::string bbar_names();

/// Space dimension of an element: 2 or 3.
inline int dimension(ElementType type) { return cell(type).dim; }
inline int nodes_per_element(ElementType type) { return cell(type).nodes; }
/// Quadrature points at which the secant modulus g is kept: one value each.
inline int points_per_element(ElementType type) { return static_cast<int>(cell(type).points.size()); }

}  // namespace kacanov
