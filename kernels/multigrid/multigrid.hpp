// SPDX-License-Identifier: BSD-3-Clause
// Matrix-free multigrid: smoothing by Chebyshev iteration or by Braess–Sarazin steps; coarsening by
// aggregation or on an octree; a direct solve or an external solver at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/vector3.hpp>
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// The symmetric matrix of a level of rigid motions, as a list of blocks. Rows of motions that move no node
/// are zero.
struct CoarseMatrix {
  int motions = 6;                        ///< per row: translations, then rotations; 3 in 2D
  const IndexMap* map = nullptr;          ///< of the rows; this rank provides the owned ones
  std::span<const Vector3> centres;       ///< of the owned rows' aggregates
  double length = 1.0;                    ///< a rotation θ moves x by θ × (x − centre) / length
  std::vector<std::int64_t> row, column;  ///< of each block, global numbers; all blocks of the owned rows
  std::vector<double> block;              ///< motions × motions entries per block, row-major
};

/// Replaces the levels below the one whose matrix it was made from.
class CoarseSolver {
 public:
  virtual ~CoarseSolver() = default;
  /// x ≈ A⁻¹ b on owned rows, `motions` entries per row: symmetric, positive definite, constant, and not
  /// longer than A⁻¹ b in the energy norm of A. Collective.
  virtual void solve(std::span<const double> b, std::span<double> x) = 0;
};

/// Creates a solver from a matrix, of which only map and centres outlive the call. Collective.
using MakeCoarseSolver = std::function<std::unique_ptr<CoarseSolver>(const CoarseMatrix&)>;

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
  /// coarsest matrix has no factor.
  void setup(std::span<const double> g, std::span<const NodeBlock> blocks, const ConstrainedSpace& space);
  /// Sets up with the g of the last setup, at a fraction of the cost if few nodes change.
  void update(std::span<const NodeBlock> blocks, const ConstrainedSpace& space);
  /// Factors of r before and of z after the cycle in single precision.
  struct Factors {
    double in = 1.0, out = 1.0;
  };
  /// z ≈ A⁻¹ r (overwrites z) times the factors. Needs a setup first.
  void apply(std::span<const double> r, std::span<double> z, const Factors& factors = {1.0, 1.0});
  /// The g of the last setup, in single precision; μ before the first.
  void secant(std::span<double> g) const;

  /// Kind of hierarchy: changes when a setup replaces the levels that later setups keep, depending on its g.
  int kind() const noexcept { return static_cast<int>(kind_); }
  /// Number of levels, the fine level included.
  int levels() const noexcept;
  std::size_t bytes() const noexcept;

  /// A fine level and the coarse spaces below it.
  class Hierarchy {
   public:
    virtual ~Hierarchy() = default;
    virtual void setup(std::span<const double> g, const NodeSupports& supports) = 0;
    virtual void update(const NodeSupports& supports) = 0;
    virtual void apply(std::span<const double> r, std::span<double> z, const Factors& factors) = 0;
    virtual void secant(std::span<double> g) const = 0;
    virtual int levels() const noexcept = 0;
    virtual std::size_t bytes() const noexcept = 0;
  };

 private:
  enum class Kind { none, grids, modes, pressures };
  enum class Averages { none, round_corners, over_elements };
  void choose(std::span<const double> g);
  bool pressures_pay(double contrast, bool flows) const;
  void give_up_pressures();
  bool take(Kind kind, std::unique_ptr<Hierarchy> hierarchy);

  MultigridBody body_;
  MultigridOptions options_;
  Averages averages_ = Averages::none;
  Kind kind_ = Kind::none;  ///< in 2D always none: there is no choice
  std::unique_ptr<Hierarchy> hierarchy_;
};

/// A cycle on displacements and pressures that returns the displacements (theory: pressure-multigrid). Null
/// if elements average over themselves and the first grid does not fit the body. For bodies in 3D with a law
/// that averages. Collective.
std::unique_ptr<Multigrid::Hierarchy> make_mixed_multigrid(const MultigridBody& body,
                                                           const MultigridOptions& options);

/// Largest k0/g of elements that average; `g`: elements × points. Collective.
double pressure_contrast(const MultigridBody& body, std::span<const double> g);

}  // namespace kacanov
