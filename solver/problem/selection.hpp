// SPDX-License-Identifier: BSD-3-Clause
// What the `on` of an entry means on a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// Smallest box round the nodes, and the length of its diagonal: the mesh's size.
struct Extent {
  Vector3 lower{}, upper{};
  double size = 0.0;
};
Extent extent(const Mesh& mesh);

/// Resolves selectors. `path` is the entry's place in the case file ("boundary[1]"), for messages. Every
/// function returns ascending indices and throws InputError for an unknown name and an empty selection.
class Selection {
 public:
  explicit Selection(const Mesh& mesh);
  std::vector<std::int32_t> facets(const Selector& on, const std::string& path) const;
  std::vector<std::int32_t> elements(const Selector& on, const std::string& path) const;
  /// Nodes of the chosen facets, and those of a named part that is made of nodes.
  std::vector<std::int32_t> nodes(const Selector& on, const std::string& path) const;

 private:
  /// Members of the part called on.name whose dimension lies within [lowest, highest].
  std::vector<const Group*> named(const Selector& on, const std::string& path, int lowest, int highest,
                                  const std::string& wanted) const;
  std::vector<std::int32_t> in_box(const Selector& on, const std::string& path,
                                   std::span<const std::int32_t> cells, int nodes_per_cell,
                                   const std::string& wanted) const;
  const Mesh& mesh_;
  Extent extent_;
};

/// Distinct nodes of facets, ascending.
std::vector<std::int32_t> nodes_of_facets(const Mesh& mesh, std::span<const std::int32_t> facets);

}  // namespace kacanov
