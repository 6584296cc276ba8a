// SPDX-License-Identifier: BSD-3-Clause
// Multigrid without a matrix on the fine level: background grids, rigid motions of aggregates, or grids with
// pressures below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "multigrid/coarse_solver.hpp"
#include "multigrid/held_space.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/node_block.hpp"

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
  /// Up to which mean k0/g bodies in 3D have background grids below the operator in place of aggregates
  /// (theory: background-cycle): half as many iterations at 2, and as much time at 30.
  double grid_contrast = 30.0;
  /// Where tr ε is averaged round corners: from which k0/g on pressures are unknowns of the cycle, too
  /// (theory: pressure-multigrid). Such a cycle takes some three times as long, and its number does not grow
  /// with k0/g.
  double pressure_contrast = 20.0;
  /// The same where elements average over themselves, whose other cycles are better and whose pressures are
  /// more: as much time at 300, two thirds of it at 1,000, at three times the memory.
  double element_contrast = 300.0;
  /// Of the levels over aggregates, the first one of at most so many rows is handed to what `make_coarse`
  /// makes, if it is too large to be factorised (theory: coarse-amg). 0: none is.
  std::int64_t coarse_rows = 0;
  MakeCoarseSolver make_coarse = {};
};

/// z = one symmetric cycle on r: z ≈ (B(g) + blocks)⁻¹ r, symmetric positive definite and fixed between two
/// setups. Level 0 is B(g) + blocks in single precision, never stored, smoothed by Chebyshev's iteration on
/// D⁻¹A with 3 × 3 blocks. The levels below are background grids in 3D where g is not far below k0 (theory:
/// background-cycle), otherwise Galerkin matrices over the rigid motions of aggregates, which pairwise
/// matching along strong couplings makes (theory: multigrid, aggregation, over-correction); the last is
/// factorised on every rank. Where tr ε is averaged and g falls far below k0 the cycle is one on
/// displacements and pressures (theory: pressure-multigrid). Vectors have the body's unknowns and are
/// consistent. Calls are collective.
class Multigrid {
 public:
  /// Nothing is set up yet. What the body points to has to outlive it.
  Multigrid(const MultigridBody& body, const MultigridOptions& options);
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;

  /// For frozen g (elements × points), the blocks of *owned* nodes (several may name one), and what the space
  /// of the solves holds. Aggregates and grids of the first time are kept. Throws InternalError where the
  /// coarsest matrix is not definite.
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space);
  /// The same with the g of the last build, at a fraction of the cost where few nodes see a change.
  void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space);
  /// What r and z are multiplied by on their way in and out of single precision.
  struct Factors {
    double in = 1.0, out = 1.0;
  };
  /// z ≈ A⁻¹ r (overwrites z) times the factors. To be called after a build.
  void apply(std::span<const double> r, std::span<double> z, const Factors& factors = {1.0, 1.0});
  /// The g of the last build, in single precision; mu before the first.
  void secant(std::span<double> g) const;

  /// Changes where a build replaces the levels that later builds keep; they follow from its g.
  int kind() const noexcept;
  /// The fine level included.
  int levels() const noexcept;
  std::size_t bytes() const noexcept;

  struct Hierarchy;  ///< for three or six rigid motions

 private:
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace kacanov
