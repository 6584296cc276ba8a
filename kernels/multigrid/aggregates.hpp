// SPDX-License-Identifier: BSD-3-Clause
// Which aggregate every node of a body belongs to, and where its middle lies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "multigrid/multigrid.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/rigid_level.hpp"

namespace kacanov {

/// Aggregates of nodes, those of a rank along strong couplings of the nodes it owns; made once. M: rigid-body
/// modes, 3 in 2D and 6 in 3D.
template <int M>
class Aggregates {
 public:
  static constexpr std::size_t dim = RigidMotion<M>::dim;

  /// g: elements × points, a stress. What the body points to has to outlive it. Collective.
  Aggregates(const MultigridBody& body, std::span<const double> g, const MultigridOptions& options);

  /// The level over them with all couplings that elements make, zero so far; from then on ghosts have an
  /// aggregate too. To be called once. Collective.
  RigidLevel<M> make_level();

  const MultigridBody& body() const noexcept { return body_; }
  int threads() const noexcept { return threads_; }
  /// Makes rotations comparable to translations: the root mean square of the nodes' distances from the middle
  /// of their aggregates.
  double length() const noexcept { return length_; }
  /// Of a local node: owned aggregates first, then those of other ranks as the level has them, then the rest.
  std::int32_t of(std::size_t node) const noexcept { return group_[node]; }
  /// Owned and others.
  std::int64_t size() const noexcept { return static_cast<std::int64_t>(centre_.size()); }
  bool is_owned(std::int32_t aggregate) const noexcept { return aggregate < owned_; }
  /// Over all ranks.
  std::int64_t number(std::int32_t aggregate) const noexcept {
    return is_owned(aggregate) ? first_ + aggregate : number_[aggregate - owned_];
  }
  std::size_t bytes() const noexcept {
    return group_.size() * sizeof(std::int32_t) + centre_.size() * sizeof(Vector3) +
           number_.size() * sizeof(std::int64_t);
  }
  /// From the middle of its aggregate to a local node.
  Vector3 offset(std::size_t node) const noexcept {
    const Vector3& centre = centre_[group_[node]];
    Vector3 d{};
    for (std::size_t c = 0; c < dim; ++c) d[c] = body_.body.mesh.coordinates[node * dim + c] - centre[c];
    return d;
  }

 private:
  MultigridBody body_;
  int threads_;
  std::vector<std::int32_t> group_;   ///< of every node: at first of the owned ones
  std::vector<Vector3> centre_;       ///< of these aggregates
  std::vector<std::int64_t> number_;  ///< of those that are not owned
  std::int32_t owned_ = 0;
  std::int64_t first_ = 0;  ///< number of the first owned one
  double length_ = 1.0;
};

extern template class Aggregates<3>;
extern template class Aggregates<6>;

}  // namespace kacanov
