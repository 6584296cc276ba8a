// SPDX-License-Identifier: BSD-3-Clause
// What a Gmsh file says, before it is made into a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kacanov/cells.hpp>

namespace kacanov {

/// The cell with this number in Gmsh among cells(), the element types that can be a body or a part of its
/// boundary; nothing for others.
std::optional<std::size_t> gmsh_cell(std::int64_t type);
/// Name of an element type of Gmsh, supported or not; empty for an unknown one.
std::string_view gmsh_type_name(std::int64_t type);

/// All elements of one type, in the order of the file.
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
  std::vector<GmshElements> elements = std::vector<GmshElements>(cells().size());  ///< as cells()
  std::vector<std::vector<int>> physicals{{}};       ///< sets of physical tags; set 0 is empty
  std::map<std::pair<int, int>, std::string> names;  ///< by (dimension, physical tag)
};

}  // namespace kacanov
