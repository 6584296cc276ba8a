// SPDX-License-Identifier: BSD-3-Clause
// Which aggregate every node of a part belongs to, and where its middle lies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "amg/rigid_level.hpp"

namespace kacanov {

/// Aggregates of nodes, those of a rank along strong couplings of the nodes it owns; made once. M: rigid-body
/// modes, 3 in 2D and 6 in 3D.
template <int M>
class Aggregates {
 public:
  static constexpr std::size_t dim = RigidMotion<M>::dim;

  /// Some `size` nodes each. g: elements × points, a stress. The part has to outlive it. Collective.
  Aggregates(const Part& part, std::span<const double> g, double size);

  /// The level over them with all couplings that elements make, zero so far; from then on ghosts have an
  /// aggregate too. To be called once. Collective.
  RigidLevel<M> make_level();

  const Part& part() const noexcept { return part_; }
  /// Makes rotations comparable to translations: the root mean square of the nodes' distances from the middle
  /// of their aggregates.
  double length() const noexcept { return length_; }
  /// Of a local node: owned aggregates first, then those of other ranks as the level has them, then the rest.
  std::int32_t of(std::size_t node) const noexcept { return group_[node]; }
  bool is_owned(std::int32_t aggregate) const noexcept { return aggregate < owned_; }
  /// Over all ranks.
  std::int64_t number(std::int32_t aggregate) const noexcept {
    return is_owned(aggregate) ? first_ + aggregate : number_[aggregate - owned_];
  }
  /// From the middle of its aggregate to a local node.
  Vector3 offset(std::size_t node) const noexcept {
    const Vector3& centre = centre_[group_[node]];
    Vector3 d{};
    for (std::size_t c = 0; c < dim; ++c) d[c] = part_.coordinates[node * dim + c] - centre[c];
    return d;
  }

 private:
  const Part& part_;
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
