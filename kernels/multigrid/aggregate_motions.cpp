// SPDX-License-Identifier: BSD-3-Clause
// Galerkin matrix over rigid motions, and the transfer between nodes and motions.
#include "multigrid/aggregate_motions.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "multigrid/motion_sums.hpp"
#include "operator/threads.hpp"

namespace kacanov {

template <int M>
void AggregateMotions<M>::sum(std::span<const double> g, const Held& held, RigidLevel<M>& level) const {
  level.clear();
  // Every thread adds only to its own rows, so that results do not depend on the number of threads.
  const int threads = aggregates_.threads();
  std::vector<BlockSums<M>> others(threads);
  in_team(threads, [&](int t) {
    MotionSums<M> sums(aggregates_, add_products_, g, &level);
    sums.take_share(t, threads);
    sums.choose(held.space, 1.0);
    sums.add_elements(body().body.mesh.element_count(), [](std::size_t i) { return i; });
    for (const NodeBlock& block : held.blocks) sums.add_block(block);
    others[t] = std::move(sums.others());
  });
  for (int t = 1; t < threads; ++t)
    for (const auto& entry : others[t].entries()) others[0].at(entry.row, entry.column) = entry.block;
  level.complete(std::move(others[0]));
}

template <int M>
void AggregateMotions<M>::change(std::span<const double> g, const Held& before, const Held& after,
                                 RigidLevel<M>& level) const {
  const MeshView& mesh = body().body.mesh;
  std::vector<std::uint8_t> moved(body().nodes(), 0);  // nodes whose held directions differ
  std::unordered_map<std::int32_t, const HeldDirections*> gone;
  for (const auto& entry : before.space.directions) gone.emplace(entry.node, &entry);
  for (const auto& entry : after.space.directions) {
    const auto old = gone.find(entry.node);
    if (old != gone.end() && old->second->count == entry.count && old->second->basis == entry.basis)
      gone.erase(old);
    else
      moved[entry.node] = 1;
  }
  for (const auto& [node, entry] : gone) moved[node] = 1;

  const std::size_t npe = nodes_per_element(mesh.type);
  std::vector<std::size_t> elements;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    if (std::any_of(&mesh.connectivity[e * npe], &mesh.connectivity[e * npe] + npe,
                    [&](std::int32_t n) { return moved[n] != 0; }))
      elements.push_back(e);
  MotionSums<M> sums(aggregates_, add_products_, g, nullptr);
  for (const auto& [held, sign] : {std::pair{&before, -1.0}, std::pair{&after, 1.0}}) {
    sums.choose(held->space, sign);
    sums.add_elements(elements.size(), [&](std::size_t i) { return elements[i]; });
    for (const NodeBlock& block : held->blocks) sums.add_block(block);
  }
  level.add(sums.others());
}

template <int M>
void AggregateMotions<M>::share_out() {
  const std::size_t owned = body().owned_nodes(), team = aggregates_.threads();
  std::int32_t groups = 0;
  for (std::size_t n = 0; n < owned; ++n) groups = std::max(groups, aggregates_.of(n) + 1);
  for (std::size_t t = 0; t < team; ++t)
    shares_.push_back({static_cast<std::int32_t>(groups * t / team),
                       static_cast<std::int32_t>(groups * (t + 1) / team), owned, 0});
  for (std::size_t n = 0; n < owned; ++n)
    for (Share& share : shares_)
      if (aggregates_.of(n) >= share.begin && aggregates_.of(n) < share.end) {
        share.first_node = std::min(share.first_node, n);
        share.last_node = n + 1;
      }
}

template <int M>
void AggregateMotions<M>::restrict_forces(std::span<const float> force, std::span<double> b) const {
  std::fill(b.begin(), b.end(), 0.0);
  in_team(aggregates_.threads(), [&](int t) {
    const Share& mine = shares_[t];
    for (std::size_t n = mine.first_node; n < mine.last_node; ++n) {
      if (aggregates_.of(n) < mine.begin || aggregates_.of(n) >= mine.end) continue;
      std::array<double, dim> f{};
      for (std::size_t c = 0; c < dim; ++c) f[c] = static_cast<double>(force[n * dim + c]);
      RigidMotion<M>::add_force(f.data(), aggregates_.offset(n).data(), 1.0 / length(),
                                b.data() + static_cast<std::size_t>(aggregates_.of(n)) * M);
    }
  });
}

template <int M>
void AggregateMotions<M>::prolong(std::span<const double> x, double gain, std::span<float> u) const {
  in_shares(aggregates_.threads(), body().owned_nodes(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      std::array<double, dim> motion{};
      RigidMotion<M>::add_motion(x.data() + static_cast<std::size_t>(aggregates_.of(n)) * M,
                                 aggregates_.offset(n).data(), 1.0 / length(), motion.data());
      for (std::size_t c = 0; c < dim; ++c) u[n * dim + c] = static_cast<float>(gain * motion[c]);
    }
  });
  std::fill(u.begin() + static_cast<std::ptrdiff_t>(body().owned_unknowns()), u.end(), 0.0F);
}

template class AggregateMotions<3>;
template class AggregateMotions<6>;

}  // namespace kacanov
