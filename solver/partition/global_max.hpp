// SPDX-License-Identifier: BSD-3-Clause
// Maximum over all ranks with its node or element, and the extent of the body.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <kacanov/part.hpp>
#include <kacanov/totals.hpp>
#include "problem/vector3.hpp"

namespace kacanov {

/// The local maximum of a rank. Ties go to the lowest index in the whole mesh, so that the position does not
/// depend on the partition.
struct GlobalMax {
  double value = -1.0;
  std::size_t local = 0;
  std::int32_t index = std::numeric_limits<std::int32_t>::max();

  void take(double candidate, std::size_t where, std::int32_t number) {
    if (!(candidate >= value) || (candidate == value && number > index)) return;
    value = candidate;
    local = where;
    index = number;
  }
};

/// Undeformed position of a node; the third component is 0 in 2D.
inline Vector3 node_position(const Part& part, std::size_t node) {
  const std::size_t dim = part.dim();
  Vector3 x{};
  for (std::size_t c = 0; c < dim; ++c) x[c] = part.coordinates[node * dim + c];
  return x;
}

/// Returns the mean of an element's nodes.
inline Vector3 element_centre(const Part& part, std::size_t element) {
  const std::size_t nodes = nodes_per_element(part.type);
  Vector3 sum{};
  for (std::size_t a = 0; a < nodes; ++a) sum = sum + node_position(part, part.elements[element * nodes + a]);
  return (1.0 / static_cast<double>(nodes)) * sum;
}

/// The maximum over all ranks and its position. at(local) and tag(local) return position and tag; they are
/// called on the rank that holds the maximum.
template <class At, class Tag>
Extreme agree(const Part& part, const GlobalMax& here, const At& at, const Tag& tag) {
  const IndexMap& node_map = part.node_map;
  Extreme extreme;
  extreme.value = std::max(node_map.max_all(here.value), 0.0);
  constexpr double none = -std::numeric_limits<double>::max();
  const double lowest = -node_map.max_all(here.value == extreme.value ? -1.0 * here.index : none);
  const bool mine = here.value == extreme.value && here.index == lowest;
  if (mine) extreme.at = at(here.local);
  node_map.sum_all(extreme.at);
  extreme.tag = node_map.sum_all(mine ? tag(here.local) : std::int64_t{0});
  return extreme;
}

/// Returns the maximum over all ranks and its position, of owned nodes or of elements. Collective.
inline Extreme agree_on_node(const Part& part, const GlobalMax& here) {
  return agree(
      part, here, [&](std::size_t n) { return node_position(part, n); },
      [&](std::size_t n) { return part.node_tag(n); });
}

inline Extreme agree_on_element(const Part& part, const GlobalMax& here) {
  return agree(
      part, here, [&](std::size_t e) { return element_centre(part, e); },
      [&](std::size_t e) { return part.element_tag(e); });
}

/// Returns the longest side of the body's bounding box, over all ranks. Collective.
inline double body_extent(const Part& part) {
  const std::size_t dim = part.dim();
  double extent = 0.0;
  for (std::size_t c = 0; c < dim; ++c) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = c; i < part.coordinates.size(); i += dim) {
      low = std::min(low, part.coordinates[i]);
      high = std::max(high, part.coordinates[i]);
    }
    extent = std::max(extent, part.node_map.max_all(high) + part.node_map.max_all(-low));
  }
  return extent;
}

}  // namespace kacanov
