// SPDX-License-Identifier: BSD-3-Clause
// Centres and numbers of aggregates, and the level of their motions.
#include "multigrid/aggregates.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "multigrid/aggregation.hpp"
#include "operator/threads.hpp"

namespace kacanov {

template <int M>
Aggregates<M>::Aggregates(const MultigridBody& body, std::span<const double> g,
                          const MultigridOptions& options)
    : body_(body), threads_(options.threads) {
  const std::span<const double> coordinates = body.body.mesh.coordinates;
  group_ = aggregate_nodes(body.body, g, body.node_map->owned,
                           {.size = options.fine_size, .threads = options.threads});
  owned_ = group_.empty() ? 0 : 1 + *std::max_element(group_.begin(), group_.end());
  centre_.assign(owned_, Vector3{});
  std::vector<double> members(centre_.size(), 0.0);
  for (std::size_t n = 0; n < group_.size(); ++n) {
    const std::size_t a = group_[n];
    members[a] += 1.0;
    for (std::size_t c = 0; c < dim; ++c) centre_[a][c] += coordinates[n * dim + c];
  }
  for (std::size_t a = 0; a < centre_.size(); ++a)
    for (double& c : centre_[a]) c /= members[a];
  double spread = 0.0;
  for (std::size_t n = 0; n < group_.size(); ++n) {
    const Vector3 d = offset(n);
    spread += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  }
  length_ = std::sqrt(body.node_map->sum_all(spread) / static_cast<double>(body.node_map->total()));
  if (!(length_ > 0.0)) length_ = 1.0;
}

template <int M>
RigidLevel<M> Aggregates<M>::make_level() {
  const IndexMap& nodes = *body_.node_map;
  const MeshView& mesh = body_.body.mesh;
  first_ = nodes.sum_below(owned_);

  // Centre and number of the aggregate of every local node; ghosts get them from their owners.
  const std::size_t owned_nodes = group_.size();
  std::vector<std::int64_t> number(body_.nodes());
  std::vector<double> centre(dim * body_.nodes());
  for (std::size_t n = 0; n < owned_nodes; ++n) {
    const std::size_t a = group_[n];
    number[n] = first_ + group_[n];
    for (std::size_t c = 0; c < dim; ++c) centre[n * dim + c] = centre_[a][c];
  }
  nodes.forward(number, 1);
  nodes.forward(centre, static_cast<int>(dim));

  // A thread's elements follow those of the previous thread, and so do the blocks that they create.
  const std::size_t npe = nodes_per_element(mesh.type), elements = mesh.element_count(), team = threads_;
  std::vector<BlockSums<M>> couplings(team);
  in_team(threads_, [&](int t) {
    const std::size_t share = t;
    std::vector<std::int64_t> distinct, before;
    for (std::size_t e = elements * share / team; e < elements * (share + 1) / team; ++e) {
      distinct.clear();
      for (std::size_t a = 0; a < npe; ++a) {
        const std::int64_t id = number[mesh.connectivity[e * npe + a]];
        if (std::find(distinct.begin(), distinct.end(), id) == distinct.end()) distinct.push_back(id);
      }
      if (distinct == before) continue;
      for (const std::int64_t row : distinct)
        for (const std::int64_t column : distinct)
          if (row <= column) couplings[share].at(row, column);
      distinct.swap(before);
    }
  });
  for (std::size_t t = 1; t < team; ++t)
    for (const auto& entry : couplings[t].entries()) couplings[0].at(entry.row, entry.column);
  RigidLevel<M> level(centre_, std::move(couplings[0]), nodes, threads_);

  group_.resize(body_.nodes());
  std::unordered_map<std::int64_t, std::int32_t>
      unknown;  // not in the level: no element here couples them to an owned one
  number_ = level.map().ghosts;
  centre_.resize(centre_.size() + number_.size());
  const auto known = static_cast<std::int32_t>(centre_.size());
  for (std::size_t n = owned_nodes; n < group_.size(); ++n) {
    const std::int64_t id = number[n];
    std::int32_t at = level.local(id);
    if (at < 0) {
      at = unknown.try_emplace(id, known + static_cast<std::int32_t>(unknown.size())).first->second;
      centre_.resize(std::max(centre_.size(), static_cast<std::size_t>(at) + 1));
      number_.resize(centre_.size() - static_cast<std::size_t>(owned_));
    }
    group_[n] = at;
    for (std::size_t c = 0; c < dim; ++c) centre_[at][c] = centre[n * dim + c];
    number_[at - owned_] = id;
  }
  return level;
}

template class Aggregates<3>;
template class Aggregates<6>;

}  // namespace kacanov
