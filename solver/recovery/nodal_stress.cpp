// SPDX-License-Identifier: BSD-3-Clause
// Nodal stress from the patch polynomials of the corners.
#include "recovery/spr_patches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "partition/global_max.hpp"

namespace kacanov {
namespace {

double von_mises(const Patches::Values& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace

StressRecovery::StressRecovery(const Part& part, const Patches& patches)
    : part_(part), patches_(patches), seen_(part.nodes(), 0.0) {
  out_.stress.assign(6 * part.nodes(), 0.0);
  out_.von_mises.assign(part.nodes(), -1.0);
}

void StressRecovery::take(const PatchFits& fits, std::size_t set, std::int32_t batch) {
  for (const std::int32_t node : patches_.corners())
    if (patches_.has(fits, node))
      take(node, patches_.polynomial(fits, set, node)(node_position(part_, node)));
  if (cell(part_.type).order > 1) take_middles(fits, set, batch);
}

NodalStress StressRecovery::result() {
  GlobalMax here;
  for (std::size_t n = 0; n < static_cast<std::size_t>(part_.owned_nodes()); ++n)
    here.take(out_.von_mises[n], n, part_.node_index[n]);
  out_.max_von_mises = agree_on_node(part_, here);
  return std::move(out_);
}

void StressRecovery::take(std::size_t node, const Patches::Values& stress) {
  const double size = von_mises(stress);
  if (!(size > out_.von_mises[node])) return;
  out_.von_mises[node] = size;
  std::copy(stress.begin(), stress.end(), &out_.stress[6 * node]);
}

void StressRecovery::take_middles(const PatchFits& fits, std::size_t set, std::int32_t batch) {
  const Cell& type = cell(part_.type);
  const std::size_t nodes = static_cast<std::size_t>(type.nodes);
  std::vector<double> mean(6 * part_.nodes(), 0.0);
  std::fill(seen_.begin(), seen_.end(), 0.0);
  for (std::size_t e = 0; e < part_.element_count(); ++e) {
    if (!patches_.is_in(e, batch)) continue;
    for (const CellEdge& edge : type.edges) {
      const std::size_t middle = part_.elements[e * nodes + edge.middle];
      if (seen_[middle] > 0.0) continue;
      seen_[middle] = 1.0;
      for (const std::int8_t end : {edge.a, edge.b}) {
        const std::size_t node = part_.elements[e * nodes + end];
        const Patches::Values value = patches_.polynomial(fits, set, node)(node_position(part_, middle));
        for (std::size_t c = 0; c < 6; ++c) mean[6 * middle + c] += 0.5 * value[c];
      }
    }
  }
  part_.node_map.sum(mean, 6);
  part_.node_map.sum(seen_, 1);
  for (std::size_t n = 0; n < part_.nodes(); ++n) {
    if (seen_[n] == 0.0) continue;
    Patches::Values stress;
    for (std::size_t c = 0; c < 6; ++c) stress[c] = mean[6 * n + c] / seen_[n];
    take(n, stress);
  }
}

}  // namespace kacanov
