// SPDX-License-Identifier: BSD-3-Clause
// Means of the volume change round the corners of a part's elements.
#include <kacanov/corner_dilatation.hpp>

#include "operator/corner_sum.hpp"

namespace kacanov {

std::vector<double> corner_dilatation(const Part& part, std::span<const double> u) {
  const Body body = part.body();
  if (corner_moduli(body).empty()) return {};
  const CornerMeans means = corner_means(body);
  std::vector<double> change(means.size()), volume(means.size());
  reference::corner_changes(body, means, u, change, volume);
  CornerSum<double> sum(means, part.node_map);
  sum(change), sum(volume);
  std::vector<double> of_element(means.of_element.size(), 0.0);
  for (std::size_t k = 0; k < of_element.size(); ++k)
    if (const std::int32_t entry = means.of_element[k]; entry >= 0)
      of_element[k] = change[entry] / volume[entry];
  return of_element;
}

}  // namespace kacanov
