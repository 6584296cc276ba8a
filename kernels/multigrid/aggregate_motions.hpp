// SPDX-License-Identifier: BSD-3-Clause
// The first coarse space: rigid motions of aggregates of nodes, and B(g) on it.
#pragma once

#include <span>

#include "multigrid/aggregates.hpp"
#include "multigrid/held_space.hpp"
#include "multigrid/node_block.hpp"
#include "simd/motion_products.hpp"

namespace kacanov {

/// Aggregates are made once, along strong couplings; which of them couple depends on them alone. What changes
/// from setup to setup is summed into the same blocks.
template <int M>
class AggregateMotions {
 public:
  /// g: elements × points, a stress. What the body points to has to outlive it. Collective.
  AggregateMotions(const MultigridBody& body, std::span<const double> g, const MultigridOptions& options)
      : aggregates_(body, g, options), add_products_(simd::motion_products<M>(options.instruction_set)) {
    share_out();
  }

  std::size_t bytes() const noexcept { return aggregates_.bytes(); }
  /// Aggregates'.
  double length() const noexcept { return aggregates_.length(); }
  RigidLevel<M> make_level() { return aggregates_.make_level(); }
  /// What a setup holds and adds: the motions of the nodes are projected onto the space.
  struct Held {
    std::span<const NodeBlock> blocks;
    const HeldSpace& space;
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
  static constexpr std::size_t dim = Aggregates<M>::dim;
  const MultigridBody& body() const noexcept { return aggregates_.body(); }
  void share_out();

  /// The aggregates of a thread in restrict_forces, and the nodes among which they all are.
  struct Share {
    std::int32_t begin = 0, end = 0;
    std::size_t first_node = 0, last_node = 0;
  };
  Aggregates<M> aggregates_;
  simd::AddMotionProducts<M> add_products_;
  std::vector<Share> shares_;
};

extern template class AggregateMotions<3>;
extern template class AggregateMotions<6>;

}  // namespace kacanov
