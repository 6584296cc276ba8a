// SPDX-License-Identifier: BSD-3-Clause
// Stress at nodes, recovered from the quadrature points round them.
#include <kacanov/nodal_stress.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <kacanov/element_fields.hpp>
#include "largest.hpp"
#include "patches.hpp"

namespace kacanov {
namespace {

using Stress = std::array<double, 6>;

double von_mises(const Stress& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/// Recovers one batch of materials after the other: those of a batch meet at no node.
class Recovery {
 public:
  Recovery(const Part& part, const BodyState& state)
      : part_(part),
        state_(state),
        type_(cell(part.type)),
        nodes_(type_.nodes),
        patches_(part),
        seen_(part.nodes(), 0.0) {
    out_.stress.assign(6 * part.nodes(), 0.0);
    out_.von_mises.assign(part.nodes(), -1.0);
  }

  NodalStress run() {
    for (std::int32_t batch = 0; batch < patches_.batches(); ++batch) recover(batch);
    Largest here;
    for (std::size_t n = 0; n < static_cast<std::size_t>(part_.owned_nodes()); ++n)
      here.take(out_.von_mises[n], n, part_.node_index[n]);
    out_.max_von_mises = agree_on_node(part_, here);
    return std::move(out_);
  }

 private:
  void recover(std::int32_t batch) {
    PatchFits fits = patches_.fits();
    visit_points(part_, state_, PointValues::all, [&](const PointRun& run) {
      for (std::size_t k = 0; k < run.position.size(); ++k) {
        const std::size_t e = run.first + k / type_.points.size();
        if (patches_.is_in(e, batch)) patches_.add(fits, e, run.position[k], &run.stress[6 * k]);
      }
    });
    patches_.solve(fits);
    take_corners(fits);
    take_middles(fits, batch);
  }

  void take(std::size_t node, const Stress& stress) {
    const double size = von_mises(stress);
    if (!(size > out_.von_mises[node])) return;
    out_.von_mises[node] = size;
    std::copy(stress.begin(), stress.end(), &out_.stress[6 * node]);
  }

  void take_corners(const PatchFits& fits) {
    for (const std::int32_t node : patches_.corners())
      if (patches_.has(fits, node)) take(node, patches_.evaluate(fits, node, node_position(part_, node)));
  }

  /// Ranks that have a middle but no element of this material there hear of it from the others.
  void take_middles(const PatchFits& fits, std::int32_t batch) {
    if (type_.order == 1) return;
    std::vector<double> mean(6 * part_.nodes(), 0.0);
    std::fill(seen_.begin(), seen_.end(), 0.0);
    for (std::size_t e = 0; e < part_.element_count(); ++e) {
      if (!patches_.is_in(e, batch)) continue;
      for (const CellEdge& edge : type_.edges) {
        const std::size_t middle = part_.elements[e * nodes_ + edge.middle];
        if (seen_[middle] > 0.0) continue;
        seen_[middle] = 1.0;
        for (const std::int8_t end : {edge.a, edge.b}) {
          const std::size_t node = part_.elements[e * nodes_ + end];
          const Stress value = patches_.evaluate(fits, node, node_position(part_, middle));
          for (std::size_t c = 0; c < 6; ++c) mean[6 * middle + c] += 0.5 * value[c];
        }
      }
    }
    part_.node_map.sum(mean, 6);
    part_.node_map.sum(seen_, 1);
    for (std::size_t n = 0; n < part_.nodes(); ++n) {
      if (seen_[n] == 0.0) continue;
      Stress stress;
      for (std::size_t c = 0; c < 6; ++c) stress[c] = mean[6 * n + c] / seen_[n];
      take(n, stress);
    }
  }

  const Part& part_;
  BodyState state_;
  const Cell& type_;
  std::size_t nodes_;
  Patches patches_;
  std::vector<double> seen_;
  NodalStress out_;
};

}  // namespace

NodalStress recover_stress(const Part& part, const BodyState& state) { return Recovery(part, state).run(); }

}  // namespace kacanov
