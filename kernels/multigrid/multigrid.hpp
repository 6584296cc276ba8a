// SPDX-License-Identifier: BSD-3-Clause
// Matrix-free multigrid with background grids, rigid motions of aggregates, or grids with pressures below.
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

/// Options of the hierarchy. The defaults were measured with perf/bench_solve; iterations are those of a beam
/// of 811,923 unknowns to 1e-8.
struct MultigridOptions {
  int threads = 1;
  std::string instruction_set;
  double fine_size = 48.0;  ///< nodes per aggregate of the first coarse level; 32: 41 iterations instead of
                            ///< 45, a third more memory
  double coarse_size =
      4.0;  ///< aggregates per aggregate on lower levels; 8: 80 iterations instead of 56, both without gain
  int fine_degree = 3, coarse_degree = 2;        ///< of the smoothing polynomials, before and after
  double fine_range = 15.0, coarse_range = 6.0;  ///< largest over smallest eigenvalue that is smoothed
  /// Factor of over-correction: piecewise rigid motions are stiffer than the modes that they represent. With
  /// 1 and 1: 56 iterations. Below 2 the cycle stays definite.
  double fine_gain = 1.5, coarse_gain = 1.3;
  int cycles = 2;  ///< 1: V-cycle, 99 iterations; 2: W-cycle, 80
  /// Maximum average k0/g at which bodies in 3D have background grids below the operator instead of
  /// aggregates (theory: background-cycle): half the iterations at 2, the same time at 30.
  double grid_contrast = 30.0;
  /// For tr ε averaged around corners: minimum k0/g at which pressures become unknowns of the cycle (theory:
  /// pressure-multigrid). Such a cycle takes about three times as long, and the iterations do not grow with
  /// k0/g.
  double pressure_contrast = 20.0;
  /// The same for elements that average over themselves, whose other cycles are better and which have more
  /// pressures: the same time at 300, two thirds of it at 1,000, with three times the memory.
  double element_contrast = 300.0;
  /// The first level of aggregates with at most this many rows is solved by the result of `make_coarse`, if
  /// it is too large for a direct solve (theory: coarse-amg). 0: none.
  std::int64_t coarse_rows = 0;
  MakeCoarseSolver make_coarse = {};
};

/// z = one symmetric cycle on r: z ≈ (B(g) + blocks)⁻¹ r, symmetric positive definite and constant between
/// setups. Level 0 is B(g) + blocks in single precision, matrix-free, smoothed by Chebyshev iteration on D⁻¹A
/// with 3 × 3 blocks. The lower levels are background grids in 3D where g is not far below k0 (theory:
/// background-cycle), otherwise Galerkin matrices over the rigid motions of aggregates from pairwise matching
/// along strong couplings (theory: multigrid, aggregation, over-correction); the last level is factorised on
/// every rank. Where tr ε is averaged and g is far below k0, the cycle works on displacements and pressures
/// (theory: pressure-multigrid). Vectors have the body's unknowns and are consistent. Calls are collective.
class Multigrid {
 public:
  /// Sets nothing up yet. The arrays that the body points to must outlive it.
  Multigrid(const MultigridBody& body, const MultigridOptions& options);
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;

  /// Sets up for frozen g (elements × points), blocks of *owned* nodes (several per node are allowed), and
  /// the space of the solves. Keeps the aggregates and grids of the first call. Throws InternalError if the
  /// coarsest matrix is not definite.
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space);
  /// Sets up with the g of the last build, at a fraction of the cost if few nodes change.
  void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space);
  /// Factors of r before and of z after the cycle in single precision.
  struct Factors {
    double in = 1.0, out = 1.0;
  };
  /// z ≈ A⁻¹ r (overwrites z) times the factors. Needs a build first.
  void apply(std::span<const double> r, std::span<double> z, const Factors& factors = {1.0, 1.0});
  /// The g of the last build, in single precision; μ before the first.
  void secant(std::span<double> g) const;

  /// Kind of hierarchy: changes when a build replaces the levels that later builds keep, depending on its g.
  int kind() const noexcept;
  /// Number of levels, the fine level included.
  int levels() const noexcept;
  std::size_t bytes() const noexcept;

  struct Hierarchy;  ///< for three or six rigid motions

 private:
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace kacanov
