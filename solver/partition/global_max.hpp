// SPDX-License-Identifier: BSD-3-Clause
// Maximum over all ranks with its node or element, and the extent of the body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <kacanov/part.hpp>
#include <kacanov/totals.hpp>

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

/// Returns the maximum over all ranks and its position, of owned nodes or of elements. Collective.
Extreme agree_on_node(const Part& part, const GlobalMax& here);
Extreme agree_on_element(const Part& part, const GlobalMax& here);

/// Returns the longest side of the body's bounding box, over all ranks. Collective.
double body_extent(const Part& part);

}  // namespace kacanov
