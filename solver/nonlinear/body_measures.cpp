// SPDX-License-Identifier: BSD-3-Clause
// Lengths and volumes of a body.
#include "nonlinear/body_measures.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

double body_extent(const Part& part) {
  const auto dim = static_cast<std::size_t>(part.dim());
  double extent = 0.0;
  for (std::size_t c = 0; c < dim; ++c) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = c; i < part.coordinates.size(); i += dim) {
      low = std::min(low, part.coordinates[i]);
      high = std::max(high, part.coordinates[i]);
    }
    extent = std::max(extent, part.halo.max_all(high) + part.halo.max_all(-low));
  }
  return extent;
}

Vector lumped_volume(const Part& part) {
  Vector volume(part.nodes(), 0.0), element(part.element_count());
  reference::volumes(part.body(), element);
  const auto npe = static_cast<std::size_t>(nodes_per_element(part.type));
  for (std::size_t k = 0; k < part.elements.size(); ++k)
    volume[static_cast<std::size_t>(part.elements[k])] += element[k / npe] / static_cast<double>(npe);
  part.halo.sum(volume, 1);
  return volume;
}

}  // namespace kacanov
