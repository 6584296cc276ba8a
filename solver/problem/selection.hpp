// SPDX-License-Identifier: BSD-3-Clause
// Resolves the `on` selectors of a model on a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// Bounding box of the nodes, and the length of its diagonal as the size of the mesh.
struct Extent {
  Vector3 lower{}, upper{};
  double size = 0.0;
};
Extent extent(const Mesh& mesh);

/// Resolves selectors. `path` is the entry's path in the case file ("boundary[1]"), for messages. All
/// functions return ascending indices and throw InputError for an unknown name or an empty selection.
class Selection {
 public:
  explicit Selection(const Mesh& mesh);
  std::vector<std::int32_t> facets(const Selector& on, const std::string& path) const;
  std::vector<std::int32_t> elements(const Selector& on, const std::string& path) const;
  /// Returns the nodes of the selected facets, or of a named group of nodes.
  std::vector<std::int32_t> nodes(const Selector& on, const std::string& path) const;

 private:
  /// Returns the groups called on.name whose dimension is within [lowest, highest].
  std::vector<const Group*> named(const Selector& on, const std::string& path, int lowest, int highest,
                                  const std::string& wanted) const;
  std::vector<std::int32_t> in_box(const Selector& on, const std::string& path,
                                   std::span<const std::int32_t> cells, int nodes_per_cell,
                                   const std::string& wanted) const;
  const Mesh& mesh_;
  Extent extent_;
};

/// Returns the distinct nodes of the facets, ascending.
std::vector<std::int32_t> nodes_of_facets(const Mesh& mesh, std::span<const std::int32_t> facets);

}  // namespace kacanov
