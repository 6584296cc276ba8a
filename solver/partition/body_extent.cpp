// SPDX-License-Identifier: BSD-3-Clause
// The size of a body over all ranks.
#include "partition/body_extent.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

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
