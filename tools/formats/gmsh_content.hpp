// SPDX-License-Identifier: BSD-3-Clause
// What a Gmsh file says, before it is made into a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kacanov {

/// Element types of Gmsh that can be a body or a part of its boundary.
enum class GmshShape : std::uint8_t { point, line2, line3, tri3, tri6, quad4, tet4, tet10, hex8 };
constexpr std::size_t gmsh_shape_count = 9;

struct GmshShapeInfo {
  const char* name;
  int gmsh_type;
  int dimension;
  int nodes;
  int corners;
};
constexpr std::array<GmshShapeInfo, gmsh_shape_count> gmsh_shapes{{{"point", 15, 0, 1, 1},
                                                                   {"line2", 1, 1, 2, 2},
                                                                   {"line3", 8, 1, 3, 2},
                                                                   {"tri3", 2, 2, 3, 3},
                                                                   {"tri6", 9, 2, 6, 3},
                                                                   {"quad4", 3, 2, 4, 4},
                                                                   {"tet4", 4, 3, 4, 4},
                                                                   {"tet10", 11, 3, 10, 4},
                                                                   {"hex8", 5, 3, 8, 8}}};

/// The shape with this number in Gmsh, if it is one of those above.
std::optional<GmshShape> gmsh_shape(std::int64_t type);
/// Name of an element type of Gmsh, supported or not; null for an unknown one.
const char* gmsh_type_name(std::int64_t type);

/// All elements of one shape, in the order of the file.
struct GmshElements {
  /// From element `first` on, the elements belong to the physical groups `GmshContent::physicals[set]`.
  struct Run {
    std::size_t first;
    std::size_t set;
  };
  std::vector<std::int32_t> nodes;  ///< node indices, in Gmsh's order
  std::vector<std::int64_t> tags;
  std::vector<Run> runs;

  std::size_t count() const noexcept { return tags.size(); }
  /// Notes the groups of the element whose tag was appended last.
  void assign_last(std::size_t set);
};

struct GmshContent {
  std::vector<double> coordinates;  ///< nodes × 3
  std::vector<std::int64_t> node_tags;
  std::array<GmshElements, gmsh_shape_count> elements;  ///< indexed by GmshShape
  std::vector<std::vector<int>> physicals{{}};          ///< sets of physical tags; set 0 is empty
  std::map<std::pair<int, int>, std::string> names;     ///< by (dimension, physical tag)

  GmshElements& of(GmshShape shape) { return elements[static_cast<std::size_t>(shape)]; }
};

}  // namespace kacanov
