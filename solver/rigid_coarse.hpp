// SPDX-License-Identifier: BSD-3-Clause
// A coarse space: the rigid motions of aggregates of nodes.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

#include "preconditioner.hpp"

namespace kacanov {

/// Z has one column a rigid motion (3 in 2D, 6 in 3D) and aggregate, zero in held components. Aggregates come from
/// METIS on each rank's node graph. The coarse matrix E = Zᵀ P (B + blocks) P Z, P the projection onto the space, is
/// summed element by element (B is never assembled) and factorised on every rank.
class RigidCoarse {
 public:
  explicit RigidCoarse(const Part& part);
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space);
  /// z += Z E⁻¹ Zᵀ r on owned nodes, for r in the space. Collective.
  void add(std::span<const double> r, std::span<double> z) const;

 private:
  using Modes = Eigen::Matrix<double, 3, 6>;  ///< a node's rows of Z; in 2D the upper left 2 × 3
  Modes node_modes(std::size_t node) const;
  void aggregate_nodes();

  const Part& part_;
  int modes_;
  std::vector<std::int32_t> aggregate_;  ///< of each local node, numbered over all ranks
  std::vector<Vector3> centre_;          ///< of each aggregate, over all ranks
  double length_ = 1.0;                  ///< scales rotations to the size of an aggregate
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace kacanov
