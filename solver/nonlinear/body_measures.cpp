// SPDX-License-Identifier: BSD-3-Clause
// Volumes of a body, and what single precision holds of it.
#include "nonlinear/body_measures.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>
#include "mesh/plain_stream.hpp"

namespace kacanov {

Vector lumped_volume(const Part& part) {
  Vector volume(part.nodes(), 0.0), element(part.element_count());
  reference::volumes(part.body(), element);
  const std::size_t npe = nodes_per_element(part.type);
  for (std::size_t k = 0; k < part.elements.size(); ++k)
    volume[part.elements[k]] += element[k / npe] / static_cast<double>(npe);
  part.node_map.sum(volume, 1);
  return volume;
}

void refuse_beyond_floats(const Part& part, std::span<const float> diagonal) {
  constexpr double most = 1e30, least = 1e-30;  // products of some eight digits more are to fit as well
  double stiffest = 0.0, softest = HUGE_VAL;
  for (const float d : diagonal) {
    stiffest = std::max(stiffest, static_cast<double>(d));
    softest = std::min(softest, static_cast<double>(d));
  }
  stiffest = part.node_map.max_all(stiffest);
  softest = -part.node_map.max_all(-softest);
  if (stiffest <= most && softest >= least) return;
  PlainText text;
  text << "material: the stiffness of nodes (modulus times width) goes from " << softest << " to " << stiffest
       << " of the middle one, expected " << least << " to " << most
       << ", which single precision holds: a part 1e8 times as stiff as another is rigid";
  throw InputError(text.str());
}

}  // namespace kacanov
