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

/// The symmetric matrix of a level over rigid motions, by rows. Motions that nothing moves have zero rows.
struct CoarseMatrix {
  int motions = 6;                   ///< of a row: translations, then rotations; 3 in 2D
  const IndexMap* map = nullptr;     ///< of the rows; this rank has the owned ones
  std::span<const Vector3> centres;  ///< of the owned rows' aggregates
  double length = 1.0;               ///< a rotation θ moves x by θ × (x − centre) / length
  std::vector<std::int64_t> start;   ///< of the owned rows' blocks, owned + 1
  std::vector<std::int64_t> column;  ///< of a block, numbered over all ranks
  std::vector<double> block;         ///< motions × motions each, by rows
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

/// The matrix of a level, which keeps only one of two symmetric blocks of owned rows.
template <int M>
CoarseMatrix coarse_matrix(const RigidLevel<M>& level, double length) {
  CoarseMatrix all{M, &level.map(), level.centres(), length, {}, {}, {}};
  const std::int32_t rows = level.rows();
  all.start.assign(static_cast<std::size_t>(rows) + 1, 0);
  const auto mirrored = [&](std::int32_t i, std::int32_t j) { return j != i && j < rows; };
  level.visit([&](std::int32_t i, std::int32_t j, const auto&) {
    ++all.start[static_cast<std::size_t>(i) + 1];
    if (mirrored(i, j)) ++all.start[static_cast<std::size_t>(j) + 1];
  });
  for (std::size_t i = 0; i < level.centres().size(); ++i) all.start[i + 1] += all.start[i];
  auto next = all.start;
  all.column.resize(all.start.back());
  all.block.resize(all.column.size() * M * M);
  const auto put = [&](std::int32_t row, std::int64_t column) {
    const auto at = static_cast<std::size_t>(next[row]++);
    all.column[at] = column;
    return &all.block[at * M * M];
  };
  level.visit([&](std::int32_t i, std::int32_t j, const auto& block) {
    double* here = put(i, level.map().number(j));
    for (std::size_t k = 0; k < M * M; ++k) here[k] = block[k];
    if (!mirrored(i, j)) return;
    double* there = put(j, level.map().number(i));
    for (std::size_t k = 0; k < M; ++k)
      for (std::size_t l = 0; l < M; ++l) there[l * M + k] = block[k * M + l];
  });
  return all;
}

}  // namespace kacanov
