// SPDX-License-Identifier: BSD-3-Clause
// A level over rigid motions handed to a solver from elsewhere.
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

/// The symmetric matrix of a level over rigid motions, as a list of blocks. Motions that nothing moves have
/// zero rows.
struct CoarseMatrix {
  int motions = 6;                        ///< of a row: translations, then rotations; 3 in 2D
  const IndexMap* map = nullptr;          ///< of the rows; this rank has the owned ones
  std::span<const Vector3> centres;       ///< of the owned rows' aggregates
  double length = 1.0;                    ///< a rotation θ moves x by θ × (x − centre) / length
  std::vector<std::int64_t> row, column;  ///< of a block, numbered over all ranks; all of the owned rows
  std::vector<double> block;              ///< motions × motions each, by rows
};

/// Solves in place of the levels below the one whose matrix it was made of.
class CoarseSolver {
 public:
  virtual ~CoarseSolver() = default;
  /// x ≈ A⁻¹ b on owned rows, `motions` entries each: symmetric, positive definite, fixed, and no longer than
  /// A⁻¹ b in the energy of A. Collective.
  virtual void solve(std::span<const double> b, std::span<double> x) = 0;
};

/// What makes one of a matrix, which goes when it returns, but for its map and centres. Collective.
using MakeCoarseSolver = std::function<std::unique_ptr<CoarseSolver>(const CoarseMatrix&)>;

/// The matrix of a level.
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
