// SPDX-License-Identifier: BSD-3-Clause
// Interface for external solvers of a level of rigid motions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>
#include "multigrid/rigid_level.hpp"

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

/// Copies the matrix of a level.
template <int M>
CoarseMatrix coarse_matrix(const RigidLevel<M>& level, double length) {
  CoarseMatrix all{M, &level.map(), level.centres(), length, {}, {}, {}};
  level.visit_rows([&](std::int64_t row, std::int64_t column, const auto& block) {
    all.row.push_back(row);
    all.column.push_back(column);
    all.block.insert(all.block.end(), block.begin(), block.end());
  });
  return all;
}

}  // namespace kacanov
