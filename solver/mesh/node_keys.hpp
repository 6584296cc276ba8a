// SPDX-License-Identifier: BSD-3-Clause
// Hash keys for edges and facets that do not depend on node order.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Key of an edge: the lower node number in the upper 32 bits.
inline std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  const std::uint64_t low = static_cast<std::uint32_t>(std::min(a, b)),
                      high = static_cast<std::uint32_t>(std::max(a, b));
  return low << 32 | high;
}

/// Extends the node fields to a new node: appends the mean over the corners around it.
inline void add_mean_of_fields(Mesh& mesh, std::span<const std::int32_t> corners) {
  for (NodeField& field : mesh.node_fields) {
    double sum = 0.0;
    for (const std::int32_t node : corners) sum += field.values[node];
    field.values.push_back(sum / static_cast<double>(corners.size()));
  }
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
