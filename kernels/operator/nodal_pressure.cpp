// SPDX-License-Identifier: BSD-3-Clause
// Averages of tr ε around corners, and the parts of an operator that has them: deviator, volume changes,
// forces of pressures.
#include "operator/nodal_pressure.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "cells/elements.hpp"
#include "cells/straight.hpp"
#include "operator/checks.hpp"
#include "operator/threaded_loops.hpp"
#include "parallel/exchange.hpp"

namespace kacanov {

std::size_t CornerLayout::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.size() * sizeof(v[0]); };
  return size(first) + size(corners) + size(shared_entry) + size(shared_place) + size(shared_first);
}

CornerLayout make_corner_layout(const Body& body, const CornerMeans& means, const Layout& layout) {
  CornerLayout out;
  out.entries = out.places = means.size();
  if (means.size() == 0) return out;
  const Cell& type = cell(body.mesh.type);
  const std::size_t lanes = layout.lanes, corners = type.corners, element_nodes = type.nodes,
                    element_points = type.points.size();
  const WorkItems items{body.mesh.type, {}, {}, {}};
  std::vector<std::int32_t> entry(layout.largest, -1);  // per local node of a block
  out.first.push_back(0);
  for (const BlockRange& range : layout.blocks) {
    for (std::size_t i = 0; i < range.group_count; ++i) {
      const simd::Group& group = layout.groups[range.first_group + i];
      const std::size_t nodes = items.nodes_of(group.shape, group.length),
                        points = items.points_of(group.shape, group.length);
      const std::int32_t* point = &layout.element_point[range.first_slot + group.first_slot];
      const std::uint16_t* index = &layout.index[range.first_index + group.first_index];
      for (std::size_t k = 0; k < group.batches * points * lanes; ++k) {
        const std::size_t lane = k % lanes, batch = k / lanes / points, p = k / lanes % points;
        if (point[k] < 0 || p % element_points > 0) continue;
        const std::size_t element = at(point[k]) / element_points;
        const std::int32_t* of = &means.of_element[element * corners];
        if (of[0] < 0) continue;
        // An item reorders its elements' nodes: the mesh defines the corner of a node.
        const std::int32_t* first = &body.mesh.connectivity[element * element_nodes];
        for (std::uint32_t a = 0; a < corners; ++a) {
          const std::size_t node =
              items.node_of(group.shape, group.length, static_cast<std::uint32_t>(p / element_points), a);
          const std::size_t local = index[(batch * nodes + node) * lanes + lane] / 4U;
          entry[local] =
              of[std::find(first, first + corners, layout.nodes[range.first_node + local]) - first];
        }
      }
    }
    for (std::uint32_t node = 0; node < range.count; ++node)
      if (const std::int32_t e = std::exchange(entry[node], -1); e >= 0) out.corners.push_back({node, e, e});
    out.first.push_back(out.corners.size());
  }
  // The thread that adds to an entry; −2 for several, −1 for none.
  std::vector<std::int32_t> owner(means.size(), -1);
  const std::size_t threads = layout.share.size() - 1;
  const auto of_thread = [&](std::size_t t) {
    const std::size_t begin = out.first[layout.share[t]], end = out.first[layout.share[t + 1]];
    return std::span(out.corners).subspan(begin, end - begin);
  };
  for (std::size_t t = 0; t < threads; ++t)
    for (const BlockCorner& corner : of_thread(t)) {
      const auto thread = static_cast<std::int32_t>(t);
      std::int32_t& of = owner[corner.entry];
      of = of == -1 || of == thread ? thread : -2;
    }
  std::vector<std::pair<std::int32_t, std::int32_t>> shared;  // entry, place: thread after thread
  std::vector<std::int32_t> place(means.size(), -1);
  for (std::size_t t = 0; t < threads; ++t) {
    const std::size_t begin = shared.size();
    for (BlockCorner& corner : of_thread(t)) {
      if (owner[corner.entry] != -2) continue;
      if (place[corner.entry] < 0) {
        place[corner.entry] = static_cast<std::int32_t>(out.places++);
        shared.emplace_back(corner.entry, place[corner.entry]);
      }
      corner.place = place[corner.entry];
    }
    for (std::size_t k = begin; k < shared.size(); ++k) place[shared[k].first] = -1;
  }
  std::sort(shared.begin(), shared.end());
  for (const auto& [e, p] : shared) {
    if (out.shared_entry.empty() || out.shared_entry.back() != e) {
      out.shared_entry.push_back(e);
      out.shared_first.push_back(out.shared_place.size());
    }
    out.shared_place.push_back(p);
  }
  out.shared_first.push_back(out.shared_place.size());
  return out;
}

std::vector<double> corner_volumes(const Body& body, const CornerMeans& means) {
  std::vector<double> volume(means.size(), 0.0);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3)
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const std::int32_t* entry = &means.of_element[e * E::corners];
        if (entry[0] < 0) continue;
        const elements::Nodal<E> x = elements::coordinates_of<E>(body.mesh, e);
        const std::array<double, E::corners> share = elements::corner_integrals<E>(x).volume;
        for (std::size_t c = 0; c < share.size(); ++c) volume[entry[c]] += share[c];
      }
  });
  return volume;
}

void separate_moduli(const Body& body, Partitioning& partitioning) {
  const std::vector<double> moduli = corner_moduli(body);
  if (moduli.size() < 2) return;
  const auto kind = [&](std::uint32_t item) {
    const Law& law = body.laws[partitioning.items.list[item].law];
    if (!averages_at_corners(law, body.mesh.type)) return std::ptrdiff_t{0};
    return std::lower_bound(moduli.begin(), moduli.end(), law.bulk) - moduli.begin();
  };
  std::vector<std::vector<std::uint32_t>> apart;
  for (const auto& members : partitioning.blocks)
    for (std::ptrdiff_t k = 0; k < static_cast<std::ptrdiff_t>(moduli.size()); ++k) {
      std::vector<std::uint32_t> same;
      std::copy_if(members.begin(), members.end(), std::back_inserter(same),
                   [&](std::uint32_t item) { return kind(item) == k; });
      if (!same.empty()) apart.push_back(std::move(same));
    }
  partitioning.blocks = std::move(apart);
}

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

template <class Real>
CornerSum<Real>::State::State(CornerRows all)
    : rows(std::move(all)), values(rows.map.size(), Real(0)), scatterer(rows.map, 1) {}

template <class Real>
CornerSum<Real>::CornerSum(const CornerMeans& means, const IndexMap& nodes) {
  if (nodes.ranks > 1) state_ = std::make_shared<State>(make_corner_rows(means, nodes));
}

template <class Real>
void CornerSum<Real>::operator()(std::span<Real> entries) {
  if (!state_) return;
  std::vector<Real>& values = state_->values;
  std::fill(values.begin(), values.end(), Real(0));
  for (std::size_t i = 0; i < entries.size(); ++i) values[state_->rows.of_entry[i]] = entries[i];
  state_->scatterer.start_sum(values);
  state_->scatterer.finish_sum(values);
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i] = values[state_->rows.of_entry[i]];
}

template class CornerSum<double>;
template class CornerSum<float>;

namespace {

void expect_pressures(bool averages, const char* member) {
  if (!averages) throw std::logic_error(std::string(member) + " where nothing is averaged");
}

}  // namespace

template <class Real>
std::size_t BasicOperator<Real>::pressures() const noexcept {
  return data_->nodal.corners.entries;
}

template <class Real>
void BasicOperator<Real>::apply_deviator(std::span<const Real> x, std::span<const Real> p, std::span<Real> y,
                                         const OnInterfaceReady& on_interface_ready) {
  expect_pressures(data_->averages(), "apply_deviator");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  if (p.empty()) return data_->apply_deviator(x.data(), y.data(), on_interface_ready);
  expect_size(p.size(), pressures(), "p");
  data_->apply_pressure(x.data(), p.data(), y.data(), on_interface_ready);
}

template <class Real>
void BasicOperator<Real>::pressure_force(std::span<const Real> p, std::span<Real> y,
                                         const OnInterfaceReady& on_interface_ready) {
  expect_pressures(data_->averages(), "pressure_force");
  expect_size(p.size(), pressures(), "p");
  expect_size(y.size(), unknowns(), "y");
  data_->apply_pressure(nullptr, p.data(), y.data(), on_interface_ready);
}

template <class Real>
void BasicOperator<Real>::volume_change(std::span<const Real> x, std::span<Real> q) {
  expect_pressures(data_->averages(), "volume_change");
  expect_size(x.size(), unknowns(), "x");
  expect_size(q.size(), pressures(), "q");
  data_->find_changes(x.data(), 1);
  std::copy_n(data_->nodal.change.begin(), q.size(), q.begin());
}

template std::size_t BasicOperator<double>::pressures() const noexcept;
template std::size_t BasicOperator<float>::pressures() const noexcept;
template void BasicOperator<double>::apply_deviator(std::span<const double>, std::span<const double>,
                                                    std::span<double>, const OnInterfaceReady&);
template void BasicOperator<float>::apply_deviator(std::span<const float>, std::span<const float>,
                                                   std::span<float>, const OnInterfaceReady&);
template void BasicOperator<double>::pressure_force(std::span<const double>, std::span<double>,
                                                    const OnInterfaceReady&);
template void BasicOperator<float>::pressure_force(std::span<const float>, std::span<float>,
                                                   const OnInterfaceReady&);
template void BasicOperator<double>::volume_change(std::span<const double>, std::span<double>);
template void BasicOperator<float>::volume_change(std::span<const float>, std::span<float>);

}  // namespace kacanov
