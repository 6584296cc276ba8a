// SPDX-License-Identifier: BSD-3-Clause
// Which ranks have each node of a mesh whose elements are dealt out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include <kacanov/constraint_rows.hpp>
#include <kacanov/mesh.hpp>

namespace kacanov {

/// Which ranks have each node, ascending: by its elements (compressed rows), and a few by wide contact
/// points.
struct Sharers {
  std::vector<std::size_t> start;
  std::vector<int> rank;
  std::map<std::size_t, std::set<int>> more;  ///< ranks without an element there
  std::span<const int> by_elements(std::size_t node) const {
    return std::span(rank).subspan(start[node], start[node + 1] - start[node]);
  }
  std::vector<int> of(std::size_t node) const {
    const auto s = by_elements(node);
    std::vector<int> all(s.begin(), s.end());
    if (const auto found = more.find(node); found != more.end()) {
      all.insert(all.end(), found->second.begin(), found->second.end());
      std::sort(all.begin(), all.end());
    }
    return all;
  }
  bool is_shared(std::size_t node) const { return by_elements(node).size() > 1 || more.contains(node); }
  bool has(std::size_t node, int who) const {
    const auto s = by_elements(node);
    if (std::binary_search(s.begin(), s.end(), who)) return true;
    if (more.empty()) return false;
    const auto found = more.find(node);
    return found != more.end() && found->second.contains(who);
  }
  /// Shared nodes are dealt out in turn, so that no rank owns a whole interface.
  int owner(std::size_t node) const {
    const auto s = by_elements(node);
    return s[node % s.size()];
  }
  /// Every rank gets the nodes of the wide points it owns.
  void widen(const ConstraintRows& contact) {
    for (std::size_t i = 0; i < contact.size(); ++i) {
      if (!contact.is_wide(i)) continue;
      const int rank_of_point = owner(contact[i].node);
      for (const RowEntry& entry : contact.entries(i)) {
        const std::size_t node = entry.node;
        if (!has(node, rank_of_point)) more[node].insert(rank_of_point);
      }
    }
  }
};

/// Of elements that belong to these ranks.
Sharers find_sharers(const Mesh& mesh, std::span<const std::uint16_t> part, int ranks);

}  // namespace kacanov
