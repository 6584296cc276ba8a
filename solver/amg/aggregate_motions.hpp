// SPDX-License-Identifier: BSD-3-Clause
// The first coarse space: rigid motions of aggregates of nodes, and B(g) on it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <kacanov/part.hpp>
#include "amg/rigid_level.hpp"
#include "linear/preconditioner.hpp"
#include "linear/space.hpp"
#include "simd/motion_products.hpp"

namespace kacanov {

/// Aggregates are made once, along strong couplings; which of them couple depends on them alone. What changes
/// from setup to setup is summed into the same blocks.
template <int M>
class AggregateMotions {
 public:
  /// Some `size` nodes each. `g`: elements × points.
  AggregateMotions(const Part& part, std::span<const double> g, double size,
                   std::string_view instruction_set);

  /// Makes rotations comparable to translations: the root mean square of the nodes' distances from their
  /// centres.
  double length() const noexcept { return length_; }
  /// The level over them with all couplings that elements make, zero so far. To be called once. Collective.
  RigidLevel<M> make_level();
  /// What a setup holds and adds: the motions of the nodes are projected onto the space.
  struct Held {
    std::span<const NodeBlock> blocks;
    const Space& space;
  };
  /// Galerkin's matrix of B(g) + blocks on the motions, into the level that make_level gave; g is rounded to
  /// single precision. Collective.
  void sum(std::span<const double> g, const Held& held, RigidLevel<M>& level) const;
  /// What `sum` gave with `before` becomes what it gives with `after` and the same g, from the elements of
  /// nodes whose held directions are others. Collective.
  void change(std::span<const double> g, const Held& before, const Held& after, RigidLevel<M>& level) const;

  /// b = what forces on the owned nodes do on the motions of owned aggregates.
  void restrict_forces(std::span<const float> force, std::span<double> b) const;
  /// u = the displacements of the owned nodes by `gain` times the motions x; zero elsewhere.
  void prolong(std::span<const double> x, double gain, std::span<float> u) const;

 private:
  static constexpr std::size_t dim = RigidMotion<M>::dim;
  class Sums;
  Vector3 offset(std::size_t node) const;

  const Part& part_;
  simd::AddMotionProducts<M> add_products_;
  std::vector<std::int32_t> group_;   ///< of every local node: owned aggregates first, then those of other
                                      ///< ranks as the level has them, then the rest
  std::vector<Vector3> centre_;       ///< of these aggregates
  std::vector<std::int64_t> number_;  ///< of those that are not owned, over all ranks
  std::int32_t owned_ = 0;            ///< aggregates
  std::int64_t first_ = 0;            ///< of the owned ones, over all ranks
  double length_ = 1.0;
};

extern template class AggregateMotions<3>;
extern template class AggregateMotions<6>;

}  // namespace kacanov
