// SPDX-License-Identifier: BSD-3-Clause
// Finds the corners around which tr ε is averaged in the blocks.
#include "operator/corners.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "cells/dispatch.hpp"
#include "cells/straight.hpp"

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
  const Units units{body.mesh.type, {}, {}, {}};
  std::vector<std::int32_t> entry(layout.largest, -1);  // per local node of a block
  out.first.push_back(0);
  for (const BlockRange& range : layout.blocks) {
    for (std::size_t i = 0; i < range.group_count; ++i) {
      const simd::Group& group = layout.groups[range.first_group + i];
      const std::size_t nodes = units.nodes_of(group.shape, group.length),
                        points = units.points_of(group.shape, group.length);
      const std::int32_t* point = &layout.element_point[range.first_slot + group.first_slot];
      const std::uint16_t* index = &layout.index[range.first_index + group.first_index];
      for (std::size_t k = 0; k < group.batches * points * lanes; ++k) {
        const std::size_t lane = k % lanes, batch = k / lanes / points, p = k / lanes % points;
        if (point[k] < 0 || p % element_points > 0) continue;
        const std::size_t element = at(point[k]) / element_points;
        const std::int32_t* of = &means.of_element[element * corners];
        if (of[0] < 0) continue;
        // A unit reorders its elements' nodes: the mesh defines the corner of a node.
        const std::int32_t* first = &body.mesh.connectivity[element * element_nodes];
        for (std::uint32_t a = 0; a < corners; ++a) {
          const std::size_t node =
              units.node_of(group.shape, group.length, static_cast<std::uint32_t>(p / element_points), a);
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

void separate_moduli(const Body& body, Division& division) {
  const std::vector<double> moduli = corner_moduli(body);
  if (moduli.size() < 2) return;
  const auto kind = [&](std::uint32_t unit) {
    const Law& law = body.laws[division.units.units[unit].law];
    if (!averages_at_corners(law, body.mesh.type)) return std::ptrdiff_t{0};
    return std::lower_bound(moduli.begin(), moduli.end(), law.bulk) - moduli.begin();
  };
  std::vector<std::vector<std::uint32_t>> apart;
  for (const auto& members : division.blocks)
    for (std::ptrdiff_t k = 0; k < static_cast<std::ptrdiff_t>(moduli.size()); ++k) {
      std::vector<std::uint32_t> same;
      std::copy_if(members.begin(), members.end(), std::back_inserter(same),
                   [&](std::uint32_t unit) { return kind(unit) == k; });
      if (!same.empty()) apart.push_back(std::move(same));
    }
  division.blocks = std::move(apart);
}

}  // namespace kacanov
