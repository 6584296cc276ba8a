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

#include <kacanov/mpi_communicator.hpp>
#include "amg/assembly.hpp"
#include "linear/preconditioner.hpp"

namespace kacanov {

/// In hypre's words.
struct BoomerAmgOptions {
  int functions = 1;              ///< unknowns a node, interleaved
  double strong_threshold = 0.5;  ///< couplings below this share of a row's largest are weak
  int aggressive_levels = 0;      ///< the first of them are coarsened twice at once
  bool nodes_together = false;    ///< coarsened by nodes, else each of their unknowns apart
  /// Whether l1 Gauss–Seidel goes there and back on the way down and on the way up; otherwise forward on the
  /// way down, backward on the way up, at half the cost.
  bool both_ways = false;
  int cycles = 1;  ///< V-cycles an application
};

/// Filled row by row, then applied: V-cycles from zero. Contributions to rows of other ranks are sent to
/// them. All is collective but add_row(); what hypre refuses is an InternalError with its words.
class BoomerAmg {
 public:
  /// This rank owns the global rows first … first + count − 1 of `total`. Throws InputError where 32-bit
  /// hypre cannot number as many.
  BoomerAmg(MPI_Comm comm, std::int64_t first, std::int64_t count, std::int64_t total);
  ~BoomerAmg();
  BoomerAmg(const BoomerAmg&) = delete;
  BoomerAmg& operator=(const BoomerAmg&) = delete;

  /// Drops the last matrix and starts a new one; upper bounds of the `count` owned rows' lengths.
  void begin(std::span<const HYPRE_Int> row_sizes);
  /// Adds values at global columns, one each, to a row of any rank.
  void add_row(HYPRE_BigInt row, std::span<HYPRE_BigInt> columns, std::span<double> values);
  /// Assembles the matrix and sets the hierarchy up. `smooth`: vectors of `count` owned entries that the
  /// interpolation should reach, besides those that are constant in one of a node's unknowns.
  void finish(const BoomerAmgOptions& options, std::span<const std::vector<double>> smooth = {});
  /// z = the V-cycles on r from zero; `count` owned entries each.
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

/// One V-cycle of BoomerAMG, the components of a node apart from each other (theory: elasticity-amg), on
/// B(g) + blocks with held components cut out. Directions that the space holds are left to the blocks.
class ElasticityAmg final : public Preconditioner {
 public:
  /// The part has to outlive it. Throws InputError where hypre cannot number the unknowns. Collective.
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
