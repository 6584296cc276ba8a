// SPDX-License-Identifier: BSD-3-Clause
// Factory for the preconditioner selected in the options, and BoomerAMG below the multigrid's aggregates.
#include "amg/make_preconditioner.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/part.hpp>
#include "amg/assembly.hpp"
#include "amg/boomer_amg.hpp"
#include "multigrid/aggregation/block_matrix.hpp"

namespace kacanov {
namespace {

/// Returns the rotations of the whole body about its centre, on the owned rows. Collective.
template <int M>
std::vector<std::vector<double>> rotations(const CoarseMatrix& matrix) {
  std::array<double, 4> sum{};
  for (const Vector3& c : matrix.centres) sum[0] += c[0], sum[1] += c[1], sum[2] += c[2], sum[3] += 1.0;
  matrix.map->sum_all(std::span<double>(sum));
  std::vector<std::vector<double>> all;
  for (int turn = RigidMotion<M>::dim; turn < M; ++turn) {
    std::array<double, M> motion{};
    motion[static_cast<std::size_t>(turn)] = 1.0;
    std::vector<double> rows(matrix.centres.size() * M, 0.0);
    for (std::size_t i = 0; i < matrix.centres.size(); ++i) {
      const Vector3& c = matrix.centres[i];
      const Vector3 d{c[0] - sum[0] / sum[3], c[1] - sum[1] / sum[3], c[2] - sum[2] / sum[3]};
      RigidMotion<M>::add_to_part(motion.data(), d.data(), 1.0 / matrix.length, &rows[i * M]);
    }
    all.push_back(std::move(rows));
  }
  return all;
}

/// The largest entry of the diagonal over all ranks.
double largest_diagonal(const CoarseMatrix& matrix) {
  const std::size_t motions = matrix.motions;
  double largest = 0.0;
  for (std::size_t k = 0; k < matrix.row.size(); ++k)
    for (std::size_t m = 0; m < motions && matrix.row[k] == matrix.column[k]; ++m)
      largest = std::max(largest, matrix.block[(k * motions + m) * motions + m]);
  return matrix.map->max_all(largest);
}

class CoarseAmg final : public CoarseSolver {
 public:
  explicit CoarseAmg(const CoarseMatrix& matrix);
  void solve(std::span<const double> b, std::span<double> x) override { amg_.apply(b.data(), x.data()); }

 private:
  BoomerAmg amg_;
};

CoarseAmg::CoarseAmg(const CoarseMatrix& matrix)
    : amg_(mpi_of(*matrix.map), matrix.map->first() * matrix.motions,
           static_cast<std::int64_t>(matrix.centres.size()) * matrix.motions,
           matrix.map->total() * matrix.motions) {
  const std::size_t motions = matrix.motions;
  const std::int64_t first = matrix.map->first();
  std::vector<HYPRE_Int> sizes(matrix.centres.size() * motions, 0);
  for (const std::int64_t row : matrix.row)
    for (std::size_t m = 0; m < motions; ++m)
      sizes[static_cast<std::size_t>(row - first) * motions + m] += matrix.motions;
  amg_.begin(sizes);
  std::vector<HYPRE_BigInt> columns(motions);
  std::vector<double> values(motions);
  const auto global = [&](std::int64_t row, std::size_t motion) {
    return static_cast<HYPRE_BigInt>(row * matrix.motions + static_cast<std::int64_t>(motion));
  };
  // Motions that boundary conditions have emptied, and rounding: a shift far below anything that moves.
  const double largest = largest_diagonal(matrix), shift = largest > 0.0 ? 1e-10 * largest : 1.0;
  for (std::size_t k = 0; k < matrix.row.size(); ++k)
    for (std::size_t m = 0; m < motions; ++m) {
      for (std::size_t n = 0; n < motions; ++n) {
        columns[n] = global(matrix.column[k], n);
        values[n] = matrix.block[(k * motions + m) * motions + n];
      }
      if (matrix.row[k] == matrix.column[k]) values[m] += shift;
      amg_.add_row(global(matrix.row[k], m), columns, values);
    }
  // Measured with tet4 at g varying by 100, 107,163 unknowns: 229 iterations with the unknowns apart and no
  // rotations, 166 with nodes together and rotations, 153 from a quarter on instead of a half, 140 there and
  // back, 112 with two cycles; 90 with this project's levels (experiments: coarse-amg).
  const BoomerAmgOptions options{.functions = matrix.motions,
                                 .strong_threshold = 0.25,
                                 .nodes_together = true,
                                 .both_ways = true,
                                 .cycles = 2};
  amg_.finish(options, matrix.motions == 6 ? rotations<6>(matrix) : rotations<3>(matrix));
}

}  // namespace

std::unique_ptr<CoarseSolver> make_coarse_amg(const CoarseMatrix& matrix) {
  return std::make_unique<CoarseAmg>(matrix);
}

std::unique_ptr<Preconditioner> make_preconditioner(const SolverOptions& options, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like) {
  if (options.preconditioner == SolverOptions::Preconditioner::elasticity)
    return std::make_unique<ElasticityAmg>(part);
  if (options.preconditioner == SolverOptions::Preconditioner::cholesky)
    return std::make_unique<Factorised>(part);
  MultigridOptions multigrid;
  multigrid.threads = threads;
  multigrid.instruction_set = instruction_set;
  multigrid.coarse_rows = options.coarse_amg;
  multigrid.make_coarse = make_coarse_amg;
  return std::make_unique<PartMultigrid>(part, multigrid, like);
}

}  // namespace kacanov
