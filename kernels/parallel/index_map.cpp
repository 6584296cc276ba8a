// SPDX-License-Identifier: BSD-3-Clause
// Index map: the indices that a rank owns, its ghosts, and their owners.
#include <kacanov/index_map.hpp>

#include <algorithm>
#include <utility>

#include <kacanov/scatterer.hpp>
#include "parallel/exchange.hpp"

namespace kacanov {

int IndexMap::owner(std::int64_t number) const noexcept {
  return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), number) - starts.begin()) - 1;
}

template <class S>
void IndexMap::forward(std::span<S> x, int components, CallSite at) const {
  Scatterer<S> scatterer(*this, components);
  scatterer.start_forward(x, at);
  scatterer.finish_forward(x);
}

template <class S>
void IndexMap::sum(std::span<S> x, int components, CallSite at) const {
  Scatterer<S> scatterer(*this, components);
  scatterer.start_sum(x, at);
  scatterer.finish_sum(x);
}

template void IndexMap::forward(std::span<double>, int, CallSite) const;
template void IndexMap::forward(std::span<float>, int, CallSite) const;
template void IndexMap::forward(std::span<std::int32_t>, int, CallSite) const;
template void IndexMap::forward(std::span<std::int64_t>, int, CallSite) const;
template void IndexMap::sum(std::span<double>, int, CallSite) const;
template void IndexMap::sum(std::span<float>, int, CallSite) const;
template void IndexMap::sum(std::span<std::int32_t>, int, CallSite) const;
template void IndexMap::sum(std::span<std::int64_t>, int, CallSite) const;

std::vector<std::int64_t> number_owned(std::int64_t owned, const Communicator& comm, CallSite at) {
  comm.expect_all_here(at, 1);
  if (comm.ranks == 1) return {0, owned};
  std::vector<std::int64_t> starts{0};
  for (const std::int64_t count : comm.transport->all(owned)) starts.push_back(starts.back() + count);
  return starts;
}

IndexMap make_index_map(const Communicator& comm, std::int32_t owned, std::vector<std::int64_t> ghosts,
                        CallSite at) {
  IndexMap map;
  static_cast<Communicator&>(map) = comm;
  map.owned = owned;
  map.starts = number_owned(owned, comm, at);
  map.ghosts = std::move(ghosts);
  if (comm.ranks == 1) return map;
  std::vector<std::vector<std::int64_t>> wanted(comm.ranks);
  std::vector<IndexMap::Neighbour> all(wanted.size());
  for (std::size_t i = 0; i < map.ghosts.size(); ++i) {
    const std::size_t from = map.owner(map.ghosts[i]);
    wanted[from].push_back(map.ghosts[i]);
    all[from].receive.push_back(owned + static_cast<std::int32_t>(i));
  }
  const Received<std::int64_t> asked = exchange_all(wanted, comm, at);
  for (std::size_t r = 0; r < all.size(); ++r) {
    all[r].rank = static_cast<int>(r);
    for (const std::int64_t number : asked.from(r))
      all[r].send.push_back(static_cast<std::int32_t>(number - map.first()));
    if (!all[r].send.empty() || !all[r].receive.empty()) map.neighbours.push_back(std::move(all[r]));
  }
  return map;
}

}  // namespace kacanov
