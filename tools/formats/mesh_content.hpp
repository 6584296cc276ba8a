// SPDX-License-Identifier: BSD-3-Clause
// Content of a mesh file before it is converted to a Mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/cells.hpp>

namespace kacanov {

/// All elements of one type, in file order.
struct ElementList {
  /// Elements from `first` on belong to the physical groups `MeshContent::physicals[set]`.
  struct Run {
    std::size_t first;
    std::size_t set;
  };
  std::vector<std::int32_t> nodes;  ///< node indices, in our order
  std::vector<std::int64_t> tags;
  std::vector<Run> runs;

  std::size_t count() const noexcept { return tags.size(); }
  /// Records the groups of the element whose tag was appended last.
  void assign_last(std::size_t set);
};

struct MeshContent {
  std::vector<double> coordinates;  ///< nodes × 3
  std::vector<std::int64_t> node_tags;
  std::vector<ElementList> elements = std::vector<ElementList>(cells().size());  ///< by cell type
  std::vector<std::vector<int>> physicals{{}};       ///< sets of physical tags; set 0 is empty
  std::map<std::pair<int, int>, std::string> names;  ///< by (dimension, physical tag)
};

}  // namespace kacanov
