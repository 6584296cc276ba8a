// SPDX-License-Identifier: BSD-3-Clause
// The interface of preconditioners for B + r CᵀMC.
#pragma once

#include <span>

#include "linear/space.hpp"
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// z ≈ (B(g) + blocks)⁻¹ r: symmetric positive definite, and constant between two setups. Vectors have the
/// part's unknowns and are consistent (see Part). Calls are collective.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Sets up for frozen g (elements × points of this part), the blocks of *owned* nodes (several may belong
  /// to one node) in addition to the part's springs, and the space of the solves.
  void setup(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space);
  /// Sets up for new blocks with the g of the last setup, much cheaper if few nodes change.
  void setup_again(std::span<const NodeBlock> blocks, const Space& space);
  /// z ≈ A⁻¹ r (overwrites z). Call setup() first.
  virtual void apply(std::span<const double> r, std::span<double> z) = 0;

  /// Returns in `g` the g of the last setup, at least in single precision; μ before the first setup.
  virtual void secant(std::span<double> g) const = 0;

  /// Changes when a setup replaces data that later setups keep, such as aggregates.
  virtual int kind() const noexcept { return 0; }

  /// Wall time of all setups so far, on this rank.
  double setup_seconds() const noexcept { return seconds_; }

 private:
  virtual void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) = 0;
  virtual void rebuild(std::span<const NodeBlock> blocks, const Space& space) = 0;
  /// Returns `blocks`, those of springs, and stiff blocks along the part's prescribed directions (theory:
  /// pinning).
  std::vector<NodeBlock> with_standing(const Part& part, std::span<const NodeBlock> blocks);

  std::vector<NodeBlock> pins_;
  bool pinned_ = false;
  double seconds_ = 0.0;
};

}  // namespace kacanov
