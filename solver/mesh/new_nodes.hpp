// SPDX-License-Identifier: BSD-3-Clause
// Parts of refinement, bisection and the conversion to quadratic elements: keys of edges and facets that do
// not depend on node order, new nodes and their tags.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/mesh.hpp>

namespace kacanov {

/// Key of an edge: the lower node number in the upper 32 bits.
inline std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  const std::uint64_t low = static_cast<std::uint32_t>(std::min(a, b)),
                      high = static_cast<std::uint32_t>(std::max(a, b));
  return low << 32 | high;
}

using MiddleNodes = std::unordered_map<std::uint64_t, std::int32_t>;  ///< edge key → node at its middle

/// Returns a mesh with the nodes of `coarse` and no elements.
inline Mesh with_nodes_of(const Mesh& coarse, ElementType type) {
  Mesh mesh;
  mesh.type = type;
  mesh.coordinates = coarse.coordinates;
  mesh.node_tags = coarse.node_tags;
  mesh.node_fields = coarse.node_fields;
  return mesh;
}

/// Appends a node with field values averaged over the nodes `around`, and returns its index. Throws
/// InputError with this message if the number of unknowns exceeds 32-bit indices.
inline std::int32_t add_node(Mesh& mesh, const std::array<double, 3>& at,
                             std::span<const std::int32_t> around, const char* too_many) {
  const std::size_t node = mesh.node_count(), dim = mesh.dim();
  if ((node + 1) * dim > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError(too_many);
  mesh.coordinates.insert(mesh.coordinates.end(), at.begin(), at.begin() + static_cast<std::ptrdiff_t>(dim));
  for (NodeField& field : mesh.node_fields) {
    double sum = 0.0;
    for (const std::int32_t one : around) sum += field.values[one];
    field.values.push_back(sum / static_cast<double>(around.size()));
  }
  return static_cast<std::int32_t>(node);
}

/// Numbers new nodes from the largest tag of the file plus 1.
inline void number_new_nodes(Mesh& mesh) {
  if (mesh.node_tags.empty()) return;
  std::int64_t next = *std::max_element(mesh.node_tags.begin(), mesh.node_tags.end());
  mesh.node_tags.reserve(mesh.node_count());
  while (mesh.node_tags.size() < mesh.node_count()) mesh.node_tags.push_back(++next);
}

/// Members of a node group of the coarse mesh in a mesh of `nodes` nodes: a point keeps its node; a line also
/// gets the middles of edges whose ends it contains.
inline std::vector<std::int32_t> with_middles(const Group& group, std::size_t nodes,
                                              const MiddleNodes& middles) {
  std::vector<std::int32_t> members = group.members;
  if (group.dimension == 0) return members;
  std::vector<char> in(nodes, 0);
  for (const std::int32_t n : group.members) in[n] = 1;
  for (const auto& [pair, node] : middles)
    if (in[pair >> 32] != 0 && in[pair & 0xffffffffU] != 0) members.push_back(node);
  return members;
}

/// Finds the boundary facets of a mesh by their corners, in any order. The mesh must outlive it.
class FacetIndex {
 public:
  explicit FacetIndex(const Mesh& mesh) {
    const std::size_t corners = cell(mesh.type).facet().corners;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
      index_.emplace(key(mesh.facet(f).first(corners)), static_cast<std::int32_t>(f));
  }
  /// Returns the facet index, or −1 if there is no such facet.
  std::int32_t find(std::span<const std::int32_t> corners) const {
    const auto found = index_.find(key(corners));
    return found == index_.end() ? -1 : found->second;
  }

 private:
  using Key = std::array<std::int32_t, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const noexcept {
      std::uint64_t h = 0;
      for (const std::int32_t n : key) h = (h ^ static_cast<std::uint32_t>(n)) * 0x9e3779b97f4a7c15U;
      return h ^ (h >> 29);
    }
  };
  static Key key(std::span<const std::int32_t> corners) {
    Key k;
    k.fill(-1);
    std::copy(corners.begin(), corners.end(), k.begin());
    std::sort(k.begin(), k.end());
    return k;
  }

  std::unordered_map<Key, std::int32_t, Hash> index_;
};

}  // namespace kacanov
