// SPDX-License-Identifier: BSD-3-Clause
// Corner averages over several ranks: one row per average, owned by the rank that owns its node.
#include "operator/corner_rows.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "distributed/exchange.hpp"

namespace kacanov {
namespace {

/// Global number of a node, and a modulus.
struct Key {
  std::int64_t node, modulus;
  auto operator<=>(const Key&) const = default;
};

/// Number of a row, and another rank that has it.
struct Sharer {
  std::int64_t row, rank;
};

}  // namespace

CornerRows make_corner_rows(const CornerMeans& means, const IndexMap& nodes) {
  CornerRows rows;
  const auto number_of = [&](std::size_t entry) {
    return means.has_patches ? means.place[entry] : nodes.number(means.place[entry]);
  };
  std::vector<std::vector<Key>> to(nodes.ranks);
  for (std::size_t i = 0; i < means.size(); ++i) {
    const std::int64_t node = number_of(i);
    to[nodes.owner(node)].push_back({node, means.modulus[i]});
  }
  const Received<Key> asked = exchange_all(to, nodes);
  std::vector<Key> own = asked.entries;
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  for (const Key& key : own) {
    rows.node.push_back(static_cast<std::int32_t>(key.node - nodes.first()));
    rows.modulus.push_back(static_cast<std::int32_t>(key.modulus));
  }
  const auto place_of = [&](const Key& key) {
    return static_cast<std::int64_t>(std::lower_bound(own.begin(), own.end(), key) - own.begin());
  };
  IndexMap& map = rows.map;
  static_cast<Communicator&>(map) = nodes;
  map.owned = static_cast<std::int32_t>(own.size());
  map.starts = number_owned(map.owned, nodes);
  // Replies to each requesting rank with the row's number and the other ranks that have it, the owner
  // included.
  const std::size_t ranks = nodes.ranks, me = nodes.rank;
  std::vector<std::vector<std::size_t>> sharers(own.size(), {me});
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Key& key : asked.from(r))
      if (r != me) sharers[place_of(key)].push_back(r);
  std::vector<std::vector<std::int64_t>> numbers(ranks);
  std::vector<std::vector<Sharer>> others(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Key& key : asked.from(r)) numbers[r].push_back(map.first() + place_of(key));
  for (std::size_t k = 0; k < sharers.size(); ++k)
    for (const std::size_t r : sharers[k])
      for (const std::size_t other : sharers[k])
        if (other != r)
          others[r].push_back({map.first() + static_cast<std::int64_t>(k), static_cast<std::int64_t>(other)});
  const Received<std::int64_t> number = exchange_all(numbers, nodes);
  const Received<Sharer> shared = exchange_all(others, nodes);
  for (std::size_t r = 0; r < ranks; ++r)
    if (r != me) map.ghosts.insert(map.ghosts.end(), number.from(r).begin(), number.from(r).end());
  std::sort(map.ghosts.begin(), map.ghosts.end());
  const auto local = [&](std::int64_t row) {
    const std::int64_t here = row - map.first();
    if (here >= 0 && here < map.owned) return static_cast<std::int32_t>(here);
    const auto at = std::lower_bound(map.ghosts.begin(), map.ghosts.end(), row);
    return map.owned + static_cast<std::int32_t>(at - map.ghosts.begin());
  };
  // Replies are in the order of the requests.
  std::vector<std::size_t> next(number.starts.begin(), number.starts.end() - 1);
  for (std::size_t i = 0; i < means.size(); ++i)
    rows.of_entry.push_back(local(number.entries[next[nodes.owner(number_of(i))]++]));
  std::map<std::int64_t, std::vector<std::int64_t>> rows_with;  // by rank
  for (const Sharer& sharer : shared.entries) rows_with[sharer.rank].push_back(sharer.row);
  for (auto& [rank, common] : rows_with) {
    std::sort(common.begin(), common.end());
    IndexMap::Neighbour neighbour;
    neighbour.rank = static_cast<int>(rank);
    for (const std::int64_t row : common) {
      const std::int32_t i = local(row);
      neighbour.shared.push_back(i);
      if (i < map.owned) neighbour.send.push_back(i);
      if (map.owner(row) == neighbour.rank) neighbour.receive.push_back(i);
      map.shared.push_back(i);
    }
    map.neighbours.push_back(std::move(neighbour));
  }
  std::sort(map.shared.begin(), map.shared.end());
  map.shared.erase(std::unique(map.shared.begin(), map.shared.end()), map.shared.end());
  return rows;
}

}  // namespace kacanov
