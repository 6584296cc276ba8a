// SPDX-License-Identifier: BSD-3-Clause
// The space of a linear solve: its free components, and the inner product over all ranks.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/cg.hpp"
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// Residual weights, one per region of nodes, so that a soft region beside a stiff one is solved relative to
/// its own forces. Without weights all nodes count equally.
struct ResidualWeights {
  std::span<const std::int32_t> region;  ///< of each local node
  std::vector<double> weight;            ///< of each region; empty: 1
  double at(std::size_t node) const noexcept { return weight[region[node]]; }
};

/// Displacements of a part that vanish in held components and, optionally, along some directions at nodes and
/// in rows over several nodes (contact rows held during a spectrum or active-set solve).
class Space {
 public:
  /// Holds only the prescribed components and directions. The part must outlive it.
  explicit Space(const Part& part);

  /// Also holds `direction` at a local node; directions of one node may be dependent. Call it on every rank
  /// that has a copy of the node.
  void hold(std::int32_t node, const Vector3& direction);
  /// Holds rows that have no node in common with these directions. Call it on every rank.
  void hold(std::shared_ptr<const HeldRows> rows) { held_.rows = std::move(rows); }

  /// Sets the weights used in all later residual norms; their values may change.
  void weigh(std::shared_ptr<const ResidualWeights> weights) { weights_ = std::move(weights); }
  const std::shared_ptr<const ResidualWeights>& weights() const noexcept { return weights_; }

  /// Everything that is held besides held components.
  const ConstrainedSpace& held() const noexcept { return held_; }

  std::size_t size() const noexcept { return part_->unknowns(); }
  const Part& part() const noexcept { return *part_; }

  /// Projects orthogonally onto the space, node by node; collective if rows over several nodes are held.
  void project(std::span<double> x) const;
  /// Inner product and 2-norm of consistent vectors over all ranks, counting each unknown once. Collective.
  double dot(std::span<const double> x, std::span<const double> y, CallSite at = CallSite()) const;
  double norm(std::span<const double> x, CallSite at = CallSite()) const;
  /// Norm of residuals: the 2-norm, or with weights that of w∘r. Collective.
  double residual_norm(std::span<const double> r, CallSite at = CallSite()) const;
  /// Returns a·b and c·d with one reduction. Collective.
  std::array<double, 2> dot2(std::span<const double> a, std::span<const double> b, std::span<const double> c,
                             std::span<const double> d, CallSite at = CallSite()) const;
  /// Returns max |x_i| over all ranks. Collective.
  double max_abs(std::span<const double> x, CallSite at = CallSite()) const;
  /// Returns the sum of `share` over all ranks. Collective.
  double sum_all(double share, CallSite at = CallSite()) const { return part_->node_map.sum_all(share, at); }
  /// One CG update in a single pass: x += α p, r −= α q. Returns the residual_norm of r. Collective.
  double advance(double alpha, std::span<const double> p, std::span<const double> q, std::span<double> x,
                 std::span<double> r) const;
  /// p = z + β p; does not read the old p if β = 0.
  void turn(double beta, std::span<const double> z, std::span<double> p) const;

 private:
  HeldDirections& directions_at(std::int32_t node);
  bool weighted() const noexcept { return weights_ != nullptr && !weights_->weight.empty(); }
  double local_dot(std::span<const double> x, std::span<const double> y) const;

  const Part* part_;
  std::shared_ptr<const ResidualWeights> weights_;
  ConstrainedSpace held_;
  std::size_t prescribed_ = 0;  ///< number of directions prescribed by the part; they come first, by node
};

}  // namespace kacanov
