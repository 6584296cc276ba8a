// SPDX-License-Identifier: BSD-3-Clause
// The largest value over all ranks with the node or element that has it, and the extent of the body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <kacanov/part.hpp>
#include <kacanov/totals.hpp>

namespace kacanov {

/// The largest value of a rank. Among equal ones that of the lowest index in the whole mesh is taken, so that
/// the place does not depend on the partition.
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

/// Undeformed; the third entry is 0 in 2D.
inline Vector3 node_position(const Part& part, std::size_t node) {
  const std::size_t dim = part.dim();
  Vector3 x{};
  for (std::size_t c = 0; c < dim; ++c) x[c] = part.coordinates[node * dim + c];
  return x;
}

/// The largest of all ranks, of owned nodes or of elements. Collective.
Extreme agree_on_node(const Part& part, const GlobalMax& here);
Extreme agree_on_element(const Part& part, const GlobalMax& here);

/// Longest side of the body's bounding box, over all ranks. Collective.
double body_extent(const Part& part);

}  // namespace kacanov
