// SPDX-License-Identifier: BSD-3-Clause
// Colours the graph of materials that share a node.
#include "law_batches.hpp"

#include <algorithm>
#include <utility>

#include "distributed/exchange.hpp"

namespace kacanov {
namespace {

/// A law at a node.
using At = std::pair<std::int32_t, std::uint16_t>;
/// Laws that share a node, both ways round.
using Edge = std::pair<std::uint16_t, std::uint16_t>;

template <class T>
void keep_each_once(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// std::pair is none of the plain structs that travel.
template <class Pair>
std::vector<Pair> gathered_pairs(const std::vector<Pair>& mine, const Communicator& comm) {
  std::vector<std::int64_t> packed;
  for (const Pair& pair : mine) packed.push_back(std::int64_t{pair.first} << 16 | pair.second);
  std::vector<Pair> all;
  for (const std::int64_t value : gathered(packed, comm))
    all.emplace_back(static_cast<typename Pair::first_type>(value >> 16),
                     static_cast<std::uint16_t>(value & 0xffff));
  keep_each_once(all);
  return all;
}

/// Of nodes that have several laws, and of those other ranks have too: the others set nothing apart.
std::vector<At> laws_at_nodes(const Part& part) {
  constexpr std::int32_t none = -1;
  const std::size_t nodes = nodes_per_element(part.type);
  std::vector<std::int32_t> first(part.nodes(), none);
  std::vector<At> at;
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    const std::int32_t node = part.elements[k];
    const std::uint16_t law = part.law_of_element[k / nodes];
    if (first[node] == none) first[node] = law;
    if (first[node] != law) at.emplace_back(node, law), at.emplace_back(node, first[node]);
  }
  for (const std::int32_t node : part.node_map.shared)
    if (first[node] != none) at.emplace_back(node, first[node]);
  keep_each_once(at);
  return at;
}

void join(std::vector<Edge>& edges, const std::vector<At>& at) {
  for (auto first = at.begin(); first != at.end();) {
    const auto last =
        std::find_if(first, at.end(), [&](const At& other) { return other.first != first->first; });
    for (auto a = first; a != last; ++a)
      for (auto b = first; b != last; ++b)
        if (a != b) edges.emplace_back(a->second, b->second);
    first = last;
  }
  keep_each_once(edges);
}

/// Laws at nodes of several ranks, by the nodes' numbers in the whole mesh.
std::vector<At> laws_at_shared_nodes(const Part& part, const std::vector<At>& at) {
  std::vector<At> shared;
  for (const std::int32_t node : part.node_map.shared)
    for (auto a = std::lower_bound(at.begin(), at.end(), At{node, 0}); a != at.end() && a->first == node; ++a)
      shared.emplace_back(part.node_index[node], a->second);
  return gathered_pairs(shared, part.node_map);
}

}  // namespace

std::vector<std::int32_t> law_batches(const Part& part) {
  std::vector<std::int32_t> batch(part.laws.size(), -1);
  if (part.laws.size() == 1) return {0};
  const std::vector<At> at = laws_at_nodes(part);
  std::vector<Edge> edges;
  join(edges, at);
  if (part.node_map.ranks > 1) {
    join(edges, laws_at_shared_nodes(part, at));
    edges = gathered_pairs(edges, part.node_map);
  }
  std::vector<std::size_t> taken_for(batch.size() + 1,
                                     batch.size());  // the law that last found a batch taken
  auto edge = edges.begin();
  for (std::size_t law = 0; law < batch.size(); ++law) {
    for (; edge != edges.end() && edge->first == law; ++edge)
      if (batch[edge->second] >= 0) taken_for[batch[edge->second]] = law;
    batch[law] = 0;
    while (taken_for[batch[law]] == law) ++batch[law];
  }
  return batch;
}

}  // namespace kacanov
