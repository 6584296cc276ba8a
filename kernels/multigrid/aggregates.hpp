// SPDX-License-Identifier: BSD-3-Clause
// Assignment of nodes to aggregates, and the centres of these.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "multigrid/multigrid.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/rigid_level.hpp"

namespace kacanov {

/// Node aggregates, formed once: those of a rank follow strong couplings of its owned nodes. M: number of
/// rigid-body modes, 3 in 2D and 6 in 3D.
template <int M>
class Aggregates {
 public:
  static constexpr std::size_t dim = RigidMotion<M>::dim;

  /// `g`: elements × points, a stress. The arrays that the body points to must outlive it. Collective.
  Aggregates(const MultigridBody& body, std::span<const double> g, const MultigridOptions& options);

  /// Creates the level of the aggregates, with zero blocks for all couplings through elements; afterwards
  /// ghosts have an aggregate too. Call it once. Collective.
  RigidLevel<M> make_level();

  const MultigridBody& body() const noexcept { return body_; }
  int threads() const noexcept { return threads_; }
  /// Length that makes rotations comparable to translations: root mean square distance of nodes from the
  /// centre of their aggregate.
  double length() const noexcept { return length_; }
  /// Aggregate of a local node: owned ones first, then those of other ranks in the order of the level, then
  /// the rest.
  std::int32_t of(std::size_t node) const noexcept { return group_[node]; }
  /// Number of owned and other aggregates.
  std::int64_t size() const noexcept { return static_cast<std::int64_t>(centre_.size()); }
  bool is_owned(std::int32_t aggregate) const noexcept { return aggregate < owned_; }
  /// Global number.
  std::int64_t number(std::int32_t aggregate) const noexcept {
    return is_owned(aggregate) ? first_ + aggregate : number_[aggregate - owned_];
  }
  std::size_t bytes() const noexcept {
    return group_.size() * sizeof(std::int32_t) + centre_.size() * sizeof(Vector3) +
           number_.size() * sizeof(std::int64_t);
  }
  /// Vector from the centre of its aggregate to a local node.
  Vector3 offset(std::size_t node) const noexcept {
    const Vector3& centre = centre_[group_[node]];
    Vector3 d{};
    for (std::size_t c = 0; c < dim; ++c) d[c] = body_.body.mesh.coordinates[node * dim + c] - centre[c];
    return d;
  }

 private:
  MultigridBody body_;
  int threads_;
  std::vector<std::int32_t> group_;   ///< per node; at first only of the owned ones
  std::vector<Vector3> centre_;       ///< per aggregate
  std::vector<std::int64_t> number_;  ///< of the aggregates that are not owned
  std::int32_t owned_ = 0;
  std::int64_t first_ = 0;  ///< global number of the first owned one
  double length_ = 1.0;
};

extern template class Aggregates<3>;
extern template class Aggregates<6>;

}  // namespace kacanov
