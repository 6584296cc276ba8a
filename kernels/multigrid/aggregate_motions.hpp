// SPDX-License-Identifier: BSD-3-Clause
// The first coarse space: rigid motions of node aggregates, with the Galerkin matrix of B(g) on it.
#pragma once

#include <span>

#include "multigrid/aggregates.hpp"
#include "multigrid/held_space.hpp"
#include "multigrid/node_block.hpp"
#include "simd/motion_products.hpp"

namespace kacanov {

/// Aggregates are formed once, along strong couplings, and alone determine the sparsity pattern. Values that
/// change between setups are summed into the same blocks.
template <int M>
class AggregateMotions {
 public:
  /// `g`: elements × points, a stress. The arrays that the body points to must outlive it. Collective.
  AggregateMotions(const MultigridBody& body, std::span<const double> g, const MultigridOptions& options)
      : aggregates_(body, g, options), add_products_(simd::motion_products<M>(options.instruction_set)) {
    share_out();
  }

  std::size_t bytes() const noexcept { return aggregates_.bytes(); }
  /// Length scale of the aggregates' rotations.
  double length() const noexcept { return aggregates_.length(); }
  RigidLevel<M> make_level() { return aggregates_.make_level(); }
  /// Inputs of a setup besides g: node blocks to add, and the space onto which node motions are projected.
  struct Held {
    std::span<const NodeBlock> blocks;
    const HeldSpace& space;
  };
  /// Sums the Galerkin matrix of B(g) + blocks on the motions into the level from make_level(); g is rounded
  /// to single precision. Collective.
  void sum(std::span<const double> g, const Held& held, RigidLevel<M>& level) const;
  /// Changes the result of sum() with `before` to that with `after` and the same g, using the elements of
  /// nodes whose held directions differ. Collective.
  void change(std::span<const double> g, const Held& before, const Held& after, RigidLevel<M>& level) const;

  /// b = the forces on the owned nodes, restricted to the motions of owned aggregates.
  void restrict_forces(std::span<const float> force, std::span<double> b) const;
  /// u = `gain` times the displacements of the owned nodes in the motions x; zero elsewhere.
  void prolong(std::span<const double> x, double gain, std::span<float> u) const;

 private:
  static constexpr std::size_t dim = Aggregates<M>::dim;
  const MultigridBody& body() const noexcept { return aggregates_.body(); }
  void share_out();

  /// A thread's aggregates in restrict_forces, and the range that contains their nodes.
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
