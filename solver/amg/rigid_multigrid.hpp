// SPDX-License-Identifier: BSD-3-Clause
// Multigrid without a matrix on the fine level: Chebyshev on the operator, rigid motions of aggregates below.
#pragma once

#include <memory>

#include "linear/distributed_operator.hpp"
#include "linear/preconditioner.hpp"

namespace kacanov {

/// Options of the hierarchy. The defaults were measured with perf/bench_solve; iterations below are those of
/// a beam of 811,923 unknowns to 1e-8.
struct MultigridOptions {
  int threads = 1;
  std::string instruction_set;
  double fine_size =
      48.0;  ///< nodes an aggregate of the first coarse level; 32: 41 its instead of 45, a third more memory
  double coarse_size =
      4.0;  ///< aggregates an aggregate of the levels below; 8: 80 its instead of 56, both without gain
  int fine_degree = 3, coarse_degree = 2;        ///< of the smoothing polynomials, before and after
  double fine_range = 15.0, coarse_range = 6.0;  ///< largest eigenvalue over the smallest that is smoothed
  /// Corrections are taken this much longer than Galerkin's: motions that are rigid by pieces are stiffer
  /// than what they stand for. 56 its with 1 and 1. Below 2 the cycle stays definite.
  double fine_gain = 1.5, coarse_gain = 1.3;
  int cycles = 2;  ///< 1: V, 2: W; 99 and 80 its
};

/// z = one symmetric cycle on r. Level 0 is B(g) + blocks in single precision, never stored, smoothed by
/// Chebyshev's iteration on D⁻¹A with 3 × 3 blocks. The levels below are Galerkin matrices over the rigid
/// motions of aggregates, which pairwise matching along strong couplings makes; the last is factorised on
/// every rank (theory: multigrid, aggregation, over-correction).
class RigidMultigrid final : public Preconditioner {
 public:
  /// Nothing is set up yet. The part has to outlive it. A setup throws InternalError where the coarsest
  /// matrix is not definite.
  RigidMultigrid(const Part& part, const MultigridOptions& options);
  ~RigidMultigrid() override;
  void apply(std::span<const double> r, std::span<double> z) override;
  void secant(std::span<double> g) const override;

  struct Hierarchy;  ///< for three or six rigid motions

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override;
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace kacanov
