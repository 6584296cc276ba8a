// SPDX-License-Identifier: BSD-3-Clause
// Averaged volume changes as functions of nodal displacements.
#include "multigrid/volume_changes.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "cells/elements.hpp"
#include "cells/straight.hpp"
#include "multigrid/summed_pattern.hpp"

namespace kacanov {
namespace {

/// Averaging elements on this rank with a wanted node: their wanted nodes and pressure entries.
struct AveragingElements {
  std::vector<std::size_t> element, first_node{0}, first_entry{0};
  std::vector<std::int32_t> node, entry;
};

template <class E>
AveragingElements averaging_elements(const Body& body, const PressureRows& pressures,
                                     std::span<const char> wanted) {
  AveragingElements all;
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const std::int32_t* entry = &pressures.means().of_element[e * E::corners];
    if (entry[0] < 0) continue;
    const std::size_t before = all.node.size();
    for (std::size_t a = 0; a < E::nodes; ++a)
      if (const std::int32_t node = body.mesh.connectivity[e * E::nodes + a]; wanted[node] != 0)
        all.node.push_back(node);
    if (all.node.size() == before) continue;
    all.element.push_back(e);
    all.entry.insert(all.entry.end(), entry, entry + E::corners);
    std::sort(all.entry.end() - E::corners, all.entry.end());
    // Corners of one patch share an entry.
    all.entry.erase(std::unique(all.entry.end() - E::corners, all.entry.end()), all.entry.end());
    all.first_node.push_back(all.node.size()), all.first_entry.push_back(all.entry.size());
  }
  return all;
}

/// An element's corners, in the order of their columns.
template <class E>
std::array<std::size_t, E::corners> by_column(const std::int32_t* entry,
                                              std::span<const std::int32_t> column) {
  std::array<std::size_t, E::corners> corners;
  std::iota(corners.begin(), corners.end(), std::size_t{0});
  std::sort(corners.begin(), corners.end(),
            [&](std::size_t c, std::size_t d) { return column[entry[c]] < column[entry[d]]; });
  return corners;
}

/// 3 values per entry of the pattern, summed over the elements on this rank.
template <class E>
std::vector<float> summed_changes(const SummedPattern& b, const AveragingElements& elements, const Body& body,
                                  const PressureRows& pressures, std::span<const std::int32_t> row,
                                  std::span<const std::int32_t> column) {
  std::vector<float> change(3 * b.entries(), 0.0F);
  for (const std::size_t e : elements.element) {
    const std::int32_t* node = body.mesh.connectivity.data() + e * E::nodes;
    const std::int32_t* entry = &pressures.means().of_element[e * E::corners];
    const auto corners = by_column<E>(entry, column);
    const auto sum = elements::corner_integrals<E>(elements::coordinates_of<E>(body.mesh, e)).change;
    for (std::size_t a = 0; a < E::nodes; ++a) {
      if (row[node[a]] < 0) continue;
      auto k = static_cast<std::size_t>(b.start()[row[node[a]]]);
      for (const std::size_t c : corners) {
        while (b.column()[k] != column[entry[c]]) ++k;
        for (std::size_t i = 0; i < 3; ++i) change[3 * k + i] += static_cast<float>(sum[a][c][i]);
      }
    }
  }
  return change;
}

template <class E>
VolumeChanges changes_of(const MultigridBody& body, const PressureRows& pressures,
                         std::span<const char> wanted, bool rows_alone, int threads) {
  const IndexMap& map = *body.node_map;
  std::vector<std::int64_t> node_number(body.nodes()), entry_number(pressures.means().size());
  for (std::size_t n = 0; n < node_number.size(); ++n) node_number[n] = map.number(n);
  for (std::size_t k = 0; k < entry_number.size(); ++k) entry_number[k] = pressures.number(k);
  const AveragingElements elements = averaging_elements<E>(body.body, pressures, wanted);
  SummedPattern b({map.starts, node_number, elements.node, elements.first_node},
                  {pressures.starts(), entry_number, elements.entry, elements.first_entry}, map, threads);
  VolumeChanges all;
  const auto start = b.start().first(body.owned_nodes() + 1);
  all.first.assign(start.begin(), start.end());
  if (!rows_alone) {
    std::vector<std::int32_t> row(body.nodes(), -1), column;
    for (std::size_t n = 0; n < row.size(); ++n)
      if (wanted[n] != 0) row[n] = b.row(node_number[n]);
    for (const std::int64_t n : entry_number) column.push_back(b.column(n));
    all.change = summed_changes<E>(b, elements, body.body, pressures, row, column);
    b.complete(all.change, 3);
    all.change.resize(3 * static_cast<std::size_t>(all.first.back()));
    for (std::size_t n = 0; n < body.owned_nodes(); ++n)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::int64_t k = all.first[n]; body.held[3 * n + i] != 0 && k < all.first[n + 1]; ++k)
          all.change[3 * k + i] = 0.0F;
  }
  for (std::size_t c = 0; c < b.columns().size(); ++c) all.number.push_back(b.columns().number(c));
  all.row = std::move(b).take_columns();
  all.row.resize(static_cast<std::size_t>(all.first.back()));  // of this rank's nodes, which come first
  return all;
}

VolumeChanges changes_of(const MultigridBody& body, const PressureRows& pressures,
                         std::span<const char> wanted, bool rows_alone, int threads) {
  VolumeChanges all;
  elements::dispatch(body.body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3) all = changes_of<E>(body, pressures, wanted, rows_alone, threads);
  });
  return all;
}

}  // namespace

VolumeChanges volume_changes(const MultigridBody& body, const PressureRows& pressures,
                             std::span<const char> wanted, int threads) {
  return changes_of(body, pressures, wanted, false, threads);
}

VolumeChanges changed_pressures(const MultigridBody& body, const PressureRows& pressures,
                                std::span<const char> wanted, int threads) {
  return changes_of(body, pressures, wanted, true, threads);
}

}  // namespace kacanov
