// SPDX-License-Identifier: BSD-3-Clause
// Maximum over all ranks with its node or element, and the extent of the body.
#include "partition/global_max.hpp"

#include <algorithm>
#include <cmath>

#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Returns the mean of an element's nodes.
Vector3 middle(const Part& part, std::size_t element) {
  const std::size_t nodes = nodes_per_element(part.type);
  Vector3 sum{};
  for (std::size_t a = 0; a < nodes; ++a) sum = sum + node_position(part, part.elements[element * nodes + a]);
  return (1.0 / static_cast<double>(nodes)) * sum;
}

/// at(local) and tag(local) return position and tag; they are called on the rank that holds the maximum.
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

}  // namespace

Extreme agree_on_node(const Part& part, const GlobalMax& here) {
  return agree(
      part, here, [&](std::size_t n) { return node_position(part, n); },
      [&](std::size_t n) { return part.node_tag(n); });
}

Extreme agree_on_element(const Part& part, const GlobalMax& here) {
  return agree(
      part, here, [&](std::size_t e) { return middle(part, e); },
      [&](std::size_t e) { return part.element_tag(e); });
}

double body_extent(const Part& part) {
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
