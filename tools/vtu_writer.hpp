// SPDX-License-Identifier: BSD-3-Clause
// Fields on unstructured grids as VTK files that ParaView opens: .vtu, its pieces under MPI (.pvtu),
// collections (.pvd).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "mesh_view.hpp"

namespace kacanov {

enum class CellShape : std::uint8_t { line2, tri3, tri6, quad4, tet4, tet10, hex8 };
CellShape body_cells(ElementType type);
CellShape facet_cells(ElementType type);

/// A named array with `components` values for every point or cell, component fastest. In a 2D grid two
/// components are padded by a zero third, so that ParaView takes them for a vector. Six are a symmetric
/// tensor: xx yy zz xy yz zx.
struct Field {
  std::string name;
  int components = 1;
  std::variant<std::span<const double>, std::span<const std::int64_t>, std::span<const std::uint8_t>> values;
};

/// A grid and its fields. Nothing is owned.
struct Grid {
  int dim = 3;
  CellShape shape = CellShape::tet4;
  std::span<const double> points;       ///< points × dim
  std::span<const std::int32_t> cells;  ///< cells × nodes, Gmsh's node order
  std::vector<Field> point_fields, cell_fields;
};

/// Each writes under a temporary name and renames, so that a file of that name is always whole. Throws
/// InternalError naming the file if it cannot be written or if a field does not fit the grid.
void write_vtu(const std::string& path, const Grid& grid);
/// One file that shows several pieces as one; `like` gives the names and types of the fields, which all
/// pieces share. Piece names are relative to the folder of `path`.
void write_pvtu(const std::string& path, const Grid& like, std::span<const std::string> pieces);

struct PvdPart {
  std::string name;  ///< shown by ParaView's extract block
  std::string file;  ///< relative to the folder of the .pvd
};
void write_pvd(const std::string& path, std::span<const PvdPart> parts);

}  // namespace kacanov
