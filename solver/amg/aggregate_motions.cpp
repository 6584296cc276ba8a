// SPDX-License-Identifier: BSD-3-Clause
// Galerkin's matrix over rigid motions, and the way between nodes and motions.
#include "amg/aggregate_motions.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "amg/motion_sums.hpp"

namespace kacanov {

template <int M>
void AggregateMotions<M>::sum(std::span<const double> g, const Held& held, RigidLevel<M>& level) const {
  level.clear();
  MotionSums<M> sums(aggregates_, add_products_, g, &level);
  sums.choose(held.space, 1.0);
  sums.add_elements(part().element_count(), [](std::size_t i) { return i; });
  for (const NodeBlock& block : held.blocks) sums.add_block(block);
  level.complete(std::move(sums.others()));
}

template <int M>
void AggregateMotions<M>::change(std::span<const double> g, const Held& before, const Held& after,
                                 RigidLevel<M>& level) const {
  std::vector<std::uint8_t> moved(part().nodes(), 0);  // nodes whose held directions are others
  std::unordered_map<std::int32_t, const Space::HeldDirections*> gone;
  for (const auto& entry : before.space.held_directions()) gone.emplace(entry.node, &entry);
  for (const auto& entry : after.space.held_directions()) {
    const auto old = gone.find(entry.node);
    if (old != gone.end() && old->second->count == entry.count && old->second->basis == entry.basis)
      gone.erase(old);
    else
      moved[entry.node] = 1;
  }
  for (const auto& [node, entry] : gone) moved[node] = 1;

  const std::size_t npe = nodes_per_element(part().type);
  std::vector<std::size_t> elements;
  for (std::size_t e = 0; e < part().element_count(); ++e)
    if (std::any_of(&part().elements[e * npe], &part().elements[e * npe] + npe,
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
void AggregateMotions<M>::restrict_forces(std::span<const float> force, std::span<double> b) const {
  std::fill(b.begin(), b.end(), 0.0);
  for (std::size_t n = 0; n < static_cast<std::size_t>(part().owned_nodes()); ++n) {
    std::array<double, dim> f{};
    for (std::size_t c = 0; c < dim; ++c) f[c] = static_cast<double>(force[n * dim + c]);
    RigidMotion<M>::add_force(f.data(), aggregates_.offset(n).data(), 1.0 / length(),
                              b.data() + static_cast<std::size_t>(aggregates_.of(n)) * M);
  }
}

template <int M>
void AggregateMotions<M>::prolong(std::span<const double> x, double gain, std::span<float> u) const {
  for (std::size_t n = 0; n < static_cast<std::size_t>(part().owned_nodes()); ++n) {
    std::array<double, dim> motion{};
    RigidMotion<M>::add_motion(x.data() + static_cast<std::size_t>(aggregates_.of(n)) * M,
                               aggregates_.offset(n).data(), 1.0 / length(), motion.data());
    for (std::size_t c = 0; c < dim; ++c) u[n * dim + c] = static_cast<float>(gain * motion[c]);
  }
  std::fill(u.begin() + static_cast<std::ptrdiff_t>(part().owned_unknowns()), u.end(), 0.0F);
}

template class AggregateMotions<3>;
template class AggregateMotions<6>;

}  // namespace kacanov
