// SPDX-License-Identifier: BSD-3-Clause
// What the loops ask of a preconditioner for B + r CᵀMC.
#pragma once

#include <span>

#include "linear/space.hpp"
#include "multigrid/node_block.hpp"

namespace kacanov {

/// z ≈ (B(g) + blocks)⁻¹ r: symmetric positive definite and fixed between two setups. Vectors have the part's
/// unknowns and are consistent (Part). Calls are collective.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// For frozen g (elements × points of this part), the blocks of *owned* nodes (several may name one) beside
  /// the part's springs, and the space the solves live in.
  void setup(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space);
  /// The same with the g of the last setup, at a fraction of the cost where few nodes see a change.
  void setup_again(std::span<const NodeBlock> blocks, const Space& space);
  /// z ≈ A⁻¹ r (overwrites z). To be called after a setup.
  virtual void apply(std::span<const double> r, std::span<double> z) = 0;

  /// The g of the last setup, in single precision at the least; mu before the first.
  virtual void secant(std::span<double> g) const = 0;

  /// Changes where a setup replaces the parts that later setups keep, such as aggregates.
  virtual int kind() const noexcept { return 0; }

  /// Wall time of all setups so far, on this rank.
  double setup_seconds() const noexcept { return seconds_; }

 private:
  virtual void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) = 0;
  virtual void rebuild(std::span<const NodeBlock> blocks, const Space& space) = 0;
  /// `blocks`, those of springs, and stiff ones along the part's held directions (theory: pinning).
  std::vector<NodeBlock> with_standing(const Part& part, std::span<const NodeBlock> blocks);

  std::vector<NodeBlock> pins_;
  bool pinned_ = false;
  double seconds_ = 0.0;
};

}  // namespace kacanov
