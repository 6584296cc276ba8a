// SPDX-License-Identifier: BSD-3-Clause
// The space a solve lives in: which components are free, and its inner product over all ranks.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/held_space.hpp"
#include "multigrid/sums.hpp"

namespace kacanov {

/// Weights of residuals, of the nodes of each region one: a soft part beside a stiff one is solved to its own
/// forces. Without any, all count the same.
struct ResidualWeights {
  std::span<const std::int32_t> region;  ///< of each local node
  std::vector<double> weight;            ///< of each region; empty: 1
  double at(std::size_t node) const noexcept { return weight[region[node]]; }
};

/// Displacements of a part that vanish in held components and, optionally, in some directions of some nodes
/// and in rows over several nodes (contact rows held during a spectrum or active-set solve).
class Space {
 public:
  /// Held are the prescribed components and directions alone. The part has to outlive it.
  explicit Space(const Part& part);

  /// Holds `direction` at a local node as well; directions of one node may be dependent. Call on every rank
  /// that has a copy of the node.
  void hold(std::int32_t node, const Vector3& direction);
  /// Holds rows that share no node with these directions. Call on every rank.
  void hold(std::shared_ptr<const HeldRows> rows) { held_.rows = std::move(rows); }

  /// From now on residuals are measured with these weights, which may change.
  void weigh(std::shared_ptr<const ResidualWeights> weights) { weights_ = std::move(weights); }
  const std::shared_ptr<const ResidualWeights>& weights() const noexcept { return weights_; }

  /// What is held besides held components.
  const HeldSpace& held() const noexcept { return held_; }

  std::size_t size() const noexcept { return part_->unknowns(); }
  const Part& part() const noexcept { return *part_; }

  /// Orthogonal projection onto the space, node by node; collective where rows over several nodes are held.
  void project(std::span<double> x) const;
  /// Inner product and 2-norm of consistent vectors over all ranks, each unknown once. Collective.
  double dot(std::span<const double> x, std::span<const double> y, CallSite at = CallSite()) const;
  double norm(std::span<const double> x, CallSite at = CallSite()) const;
  /// By what residuals are measured: the 2-norm, or, where parts of the body have weights, that of w∘r.
  /// Collective.
  double residual_norm(std::span<const double> r, CallSite at = CallSite()) const;
  /// a·b and c·d for the price of one reduction. Collective.
  std::array<double, 2> dot2(std::span<const double> a, std::span<const double> b, std::span<const double> c,
                             std::span<const double> d, CallSite at = CallSite()) const;
  /// max |x_i| over all ranks. Collective.
  double max_abs(std::span<const double> x, CallSite at = CallSite()) const;
  /// Over all ranks, of what each has. Collective.
  double sum_all(double share, CallSite at = CallSite()) const { return part_->node_map.sum_all(share, at); }
  /// A step of conjugate gradients in one pass: x += α p, r −= α q. Returns the residual_norm of r.
  /// Collective.
  double advance(double alpha, std::span<const double> p, std::span<const double> q, std::span<double> x,
                 std::span<double> r) const;
  /// p = z + β p; with β = 0 the old p is not read.
  void turn(double beta, std::span<const double> z, std::span<double> p) const;

 private:
  HeldDirections& directions_at(std::int32_t node);
  bool weighted() const noexcept { return weights_ != nullptr && !weights_->weight.empty(); }
  double local_dot(std::span<const double> x, std::span<const double> y) const;

  const Part* part_;
  std::shared_ptr<const ResidualWeights> weights_;
  HeldSpace held_;
  std::size_t prescribed_ = 0;  ///< directions that the part holds come first, by node
};

}  // namespace kacanov
