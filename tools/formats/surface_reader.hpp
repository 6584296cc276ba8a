// SPDX-License-Identifier: BSD-3-Clause
// Reads obstacle surfaces: STL, ASCII and binary, and the facets of Gmsh files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <kacanov/surface.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Triangles by corner indices; outward normals follow the right-hand rule.
struct TriangleList {
  std::vector<Vector3> points;
  std::vector<Surface::Triangle> triangles;
};

/// `bytes` is the whole file; `source` names it in messages. Normals in the file are ignored: the order of
/// the corners counts. Throws InputError naming the line (ASCII) or triangle (binary) of an error.
TriangleList parse_stl(const SourceFile& source, std::string_view bytes);

/// Reads an STL or Gmsh file, recognised by its first bytes. `group`: physical group of a Gmsh file; empty:
/// all facets. Four-node facets are split into two triangles, six-node facets into four. Throws InputError
/// naming the file.
Surface read_surface(const SourceFile& source, const std::string& group);

}  // namespace kacanov
