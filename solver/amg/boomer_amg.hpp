// SPDX-License-Identifier: BSD-3-Clause
// hypre's BoomerAMG: a matrix of nodal blocks in hypre, the cycle on it, and the preconditioner of the
// assembled body.
#pragma once

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "amg/assembly.hpp"
#include "linear/preconditioner.hpp"

namespace kacanov {

/// In hypre's words.
struct BoomerAmgOptions {
  int functions = 1;              ///< unknowns per node, interleaved
  double strong_threshold = 0.5;  ///< couplings below this share of the row's largest are weak
  int aggressive_levels = 0;      ///< number of finest levels with aggressive (double) coarsening
  bool nodes_together = false;    ///< coarsens by nodes instead of each unknown separately
  /// Whether l1 Gauss–Seidel sweeps are symmetric in both branches of the cycle. Otherwise they are forward
  /// on the way down and backward on the way up, at half the cost.
  bool both_ways = false;
  int cycles = 1;  ///< V-cycles per application
};

/// A matrix that is filled row by row and then applied as V-cycles with zero initial guess. Contributions to
/// rows of other ranks are sent to them. All members except add_row() are collective; hypre errors are thrown
/// as InternalError with hypre's message.
class BoomerAmg {
 public:
  /// This rank owns the global rows first … first + count − 1 of `total`. Throws InputError if hypre with
  /// 32-bit indices cannot number them.
  BoomerAmg(MPI_Comm comm, std::int64_t first, std::int64_t count, std::int64_t total);
  ~BoomerAmg();
  BoomerAmg(const BoomerAmg&) = delete;
  BoomerAmg& operator=(const BoomerAmg&) = delete;

  /// Discards the last matrix and starts a new one; `row_sizes` are upper bounds of the lengths of the owned
  /// rows.
  void begin(std::span<const HYPRE_Int> row_sizes);
  /// Adds values at global columns, one value per column, to a row of any rank.
  void add_row(HYPRE_BigInt row, std::span<HYPRE_BigInt> columns, std::span<double> values);
  /// Assembles the matrix and sets up the hierarchy. `smooth`: vectors of `count` owned entries that the
  /// interpolation should reproduce in addition to constants in each unknown.
  void finish(const BoomerAmgOptions& options, std::span<const std::vector<double>> smooth = {});
  /// z = result of the V-cycles on r with zero initial guess; `count` owned entries each.
  void apply(const double* r, double* z);

 private:
  void release();
  void reach(std::span<const std::vector<double>> smooth);

  MPI_Comm comm_;
  Communicator ranks_;
  HYPRE_BigInt first_ = 0, count_ = 0;
  HYPRE_IJMatrix matrix_ = nullptr;
  HYPRE_ParCSRMatrix object_ = nullptr;
  HYPRE_Solver solver_ = nullptr;
  HYPRE_IJVector right_ = nullptr, left_ = nullptr;
  HYPRE_ParVector right_object_ = nullptr, left_object_ = nullptr;
  std::vector<HYPRE_IJVector> smooth_;
  std::vector<HYPRE_ParVector> smooth_objects_;
};

/// One V-cycle of unknown-based BoomerAMG (theory: elasticity-amg) on B(g) + blocks without the held
/// components. Directions held by the space are represented by the blocks only.
class ElasticityAmg final : public Preconditioner {
 public:
  /// The part must outlive it. Throws InputError if hypre cannot number the unknowns. Collective.
  explicit ElasticityAmg(const Part& part);
  void apply(std::span<const double> r, std::span<double> z) override;
  void secant(std::span<double> g) const override;

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override;
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override {
    build(std::vector<double>(g_), blocks, space);
  }

  const Part& part_;
  std::vector<double> g_;
  BoomerAmg amg_;
};

}  // namespace kacanov
