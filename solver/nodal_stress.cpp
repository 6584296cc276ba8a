// SPDX-License-Identifier: BSD-3-Clause
// Stress at nodes, recovered from the quadrature points round them.
#include <kacanov/nodal_stress.hpp>

#include <algorithm>
#include <cmath>

#include <kacanov/element_fields.hpp>
#include "largest.hpp"
#include "law_batches.hpp"
#include "patch_fit.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

using Stress = std::array<double, 6>;

double von_mises(const Stress& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/// Corners of the part's elements, numbered on their own: middles of edges have no patch.
class Corners {
 public:
  explicit Corners(const Part& part) : of_node_(part.nodes(), -1) {
    const std::size_t nodes = nodes_per_element(part.type);
    const std::size_t corners = cell(part.type).corners;
    for (std::size_t k = 0; k < part.elements.size(); ++k) {
      if (k % nodes >= corners) continue;
      std::int32_t& corner = of_node_[part.elements[k]];
      if (corner < 0) corner = count_++;
    }
    for (std::size_t n = 0; n < of_node_.size(); ++n)
      if (of_node_[n] >= 0) node_.resize(static_cast<std::size_t>(count_)), node_[of_node_[n]] = n;
  }
  std::size_t count() const noexcept { return static_cast<std::size_t>(count_); }
  std::ptrdiff_t of_node(std::size_t node) const noexcept { return of_node_[node]; }
  std::size_t node(std::size_t corner) const noexcept { return node_[corner]; }

 private:
  std::vector<std::int32_t> of_node_;
  std::vector<std::size_t> node_;
  std::int32_t count_ = 0;
};

/// Recovers one batch of materials after the other: those of a batch meet at no node.
class Recovery {
 public:
  Recovery(const Part& part, const BodyState& state)
      : part_(part),
        state_(state),
        type_(cell(part.type)),
        nodes_(type_.nodes),
        corner_(part),
        size_(patch_sizes()),
        batch_of_law_(law_batches(part)),
        seen_(part.nodes(), 0.0) {
    out_.stress.assign(6 * part.nodes(), 0.0);
    out_.von_mises.assign(part.nodes(), -1.0);
  }

  NodalStress run() {
    const std::int32_t last = *std::max_element(batch_of_law_.begin(), batch_of_law_.end());
    for (std::int32_t batch = 0; batch <= last; ++batch) recover(batch);
    Largest here;
    for (std::size_t n = 0; n < static_cast<std::size_t>(part_.owned_nodes()); ++n)
      here.take(out_.von_mises[n], n, part_.node_index[n]);
    out_.max_von_mises = agree_on_node(part_, here);
    return std::move(out_);
  }

 private:
  /// The third root of the volume round each corner, or the square root of an area.
  std::vector<double> patch_sizes() const {
    std::vector<double> of_element(part_.element_count()), size(part_.nodes(), 0.0);
    reference::volumes(part_.body(), of_element);
    for (std::size_t k = 0; k < part_.elements.size(); ++k) size[part_.elements[k]] += of_element[k / nodes_];
    part_.node_map.sum(size, 1);
    for (double& v : size) v = part_.dim() == 3 ? std::cbrt(v) : std::sqrt(v);
    return size;
  }

  Vector3 from_corner(const Vector3& x, std::size_t node) const {
    return (1.0 / size_[node]) * (x - node_position(part_, node));
  }
  bool is_in(std::size_t element, std::int32_t batch) const {
    return part_.law_of_element.empty() || batch_of_law_[part_.law_of_element[element]] == batch;
  }

  void recover(std::int32_t batch) {
    PatchFits fits(corner_.count(), Monomials(part_.dim(), type_.order));
    visit_point_stress(part_, state_, [&](const PointRun& run) {
      for (std::size_t k = 0; k < run.position.size(); ++k) {
        const std::size_t e = run.first + k / type_.points.size();
        if (!is_in(e, batch)) continue;
        for (std::size_t a = 0; a < static_cast<std::size_t>(type_.corners); ++a) {
          const std::size_t node = part_.elements[e * nodes_ + a];
          fits.add(corner_.of_node(node), from_corner(run.position[k], node), &run.stress[6 * k]);
        }
      }
    });
    add_up(fits);
    fits.solve();
    take_corners(fits);
    take_middles(fits, batch);
  }

  /// Over the ranks that share a corner.
  void add_up(PatchFits& fits) const {
    if (part_.node_map.ranks == 1) return;
    std::vector<double> one(part_.nodes(), 0.0);
    for (std::size_t k = 0; k < fits.width(); ++k) {
      for (const std::int32_t n : part_.node_map.shared) {
        const std::ptrdiff_t corner = corner_.of_node(n);
        one[n] = corner < 0 ? 0.0 : fits.sums(corner)[k];
      }
      part_.node_map.sum(one, 1);
      for (const std::int32_t n : part_.node_map.shared)
        if (const std::ptrdiff_t corner = corner_.of_node(n); corner >= 0) fits.sums(corner)[k] = one[n];
    }
  }

  void take(std::size_t node, const Stress& stress) {
    const double size = von_mises(stress);
    if (!(size > out_.von_mises[node])) return;
    out_.von_mises[node] = size;
    std::copy(stress.begin(), stress.end(), &out_.stress[6 * node]);
  }

  void take_corners(const PatchFits& fits) {
    for (std::size_t corner = 0; corner < corner_.count(); ++corner)
      if (fits.has(corner)) take(corner_.node(corner), fits.evaluate(corner, {}));
  }

  /// Ranks that have a middle but no element of this material there hear of it from the others.
  void take_middles(const PatchFits& fits, std::int32_t batch) {
    if (type_.order == 1) return;
    std::vector<double> mean(6 * part_.nodes(), 0.0);
    std::fill(seen_.begin(), seen_.end(), 0.0);
    for (std::size_t e = 0; e < part_.element_count(); ++e) {
      if (!is_in(e, batch)) continue;
      for (const CellEdge& edge : type_.edges) {
        const std::size_t middle = part_.elements[e * nodes_ + edge.middle];
        if (seen_[middle] > 0.0) continue;
        seen_[middle] = 1.0;
        for (const std::int8_t end : {edge.a, edge.b}) {
          const std::size_t node = part_.elements[e * nodes_ + end];
          const Stress value =
              fits.evaluate(corner_.of_node(node), from_corner(node_position(part_, middle), node));
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
  Corners corner_;
  std::vector<double> size_;
  std::vector<std::int32_t> batch_of_law_;
  std::vector<double> seen_;
  NodalStress out_;
};

}  // namespace

NodalStress recover_stress(const Part& part, const BodyState& state) { return Recovery(part, state).run(); }

}  // namespace kacanov
