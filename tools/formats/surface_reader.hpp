// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of obstacles: STL, ASCII and binary, and the facets of Gmsh files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <kacanov/surface.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Corners of triangles, outer normals by the right-hand rule.
struct TriangleList {
  std::vector<Vector3> points;
  std::vector<Surface::Triangle> triangles;
};

/// `bytes` is the whole file, `path` its name in messages. What the file says of normals is not read: the
/// order of the corners counts. Throws InputError naming the line (ASCII) or triangle (binary) of what is
/// wrong.
TriangleList parse_stl(const SourceFile& source, std::string_view bytes);

/// An STL or Gmsh file, told apart by how it begins. `group`: the physical group of a Gmsh file whose facets
/// are meant; empty: all there are. Facets of four nodes are cut in two; middle nodes cut those of six in
/// four. Throws InputError naming the file.
Surface read_surface(const SourceFile& source, const std::string& group);

}  // namespace kacanov
