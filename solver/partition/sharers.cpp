// SPDX-License-Identifier: BSD-3-Clause
// Which ranks have each node of a mesh whose elements are dealt out.
#include "partition/sharers.hpp"

#include <numeric>

namespace kacanov {

Sharers find_sharers(const Mesh& mesh, std::span<const std::uint16_t> part, int ranks) {
  Sharers sharers;
  const std::size_t nodes = mesh.node_count();
  const std::size_t npe = nodes_per_element(mesh.type);
  sharers.start.assign(nodes + 1, 0);
  if (ranks == 1) {
    std::iota(sharers.start.begin(), sharers.start.end(), std::size_t{0});
    sharers.rank.assign(nodes, 0);
    return sharers;
  }
  // A first pass tells the inner nodes, which are most, by their only rank; the few others have lists.
  constexpr int none = -1, several = -2;
  std::vector<int> only(nodes, none);
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    int& rank = only[mesh.elements[k]];
    const int here = part[k / npe];
    if (rank == none) rank = here;
    if (rank != here) rank = several;
  }
  std::map<std::size_t, std::set<int>> lists;
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    const std::size_t n = mesh.elements[k];
    if (only[n] == several) lists[n].insert(part[k / npe]);
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    if (only[n] == several)
      sharers.rank.insert(sharers.rank.end(), lists[n].begin(), lists[n].end());
    else
      sharers.rank.push_back(only[n]);
    sharers.start[n + 1] = sharers.rank.size();
  }
  return sharers;
}

}  // namespace kacanov
