// SPDX-License-Identifier: BSD-3-Clause
// The last grid of displacements and pressures, solved directly.
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <span>
#include <vector>

#include <kacanov/error.hpp>
#include "multigrid/grid_level.hpp"

namespace kacanov {

/// A factor L D Lᵀ of [A Bᵀ; B −C], the same on every rank: with A and C definite there is one for any order
/// of the unknowns (Vanderbei, SIAM J. Optim. 5 (1995) 100–113).
class PressureDirect {
 public:
  /// Throws InternalError where there is none. The level's map has to outlive it. Collective.
  explicit PressureDirect(const GridLevel& level) : map_(&level.map()), rows_(level.rows()) {
    const auto size = static_cast<Eigen::Index>(map_->total()) * 4;
    std::vector<Eigen::Triplet<double>> triplets;
    double stiffest = 0.0, softest = 0.0;
    for (const auto& entry : level.blocks().gathered())
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          const double v = entry.block[i * 4 + j];
          triplets.emplace_back(static_cast<Eigen::Index>(entry.row) * 4 + i,
                                static_cast<Eigen::Index>(entry.column) * 4 + j, v);
          if (entry.row == entry.column && i == j)
            (i < 3 ? stiffest : softest) = std::max(i < 3 ? stiffest : softest, i < 3 ? v : -v);
        }
    // What no node moves with, and rounding: shifts far below anything else, towards definiteness.
    for (Eigen::Index i = 0; i < size; ++i)
      triplets.emplace_back(i, i, i % 4 < 3 ? 1e-10 * stiffest : -1e-10 * softest);
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factor_.compute(matrix);
    if (factor_.info() != Eigen::Success)
      throw InternalError("the coarsest matrix of the preconditioner has no factor");
  }

  /// Collective.
  void solve(const GridVector& b, GridVector& x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(map_->total()) * 4);
    const auto at = static_cast<Eigen::Index>(map_->first()) * 4;
    const auto here = [&](std::size_t i, std::size_t c) { return at + static_cast<Eigen::Index>(4 * i + c); };
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t c = 0; c < 3; ++c) all[here(i, c)] = b.u[GridVector::width * i + c];
      all[here(i, 3)] = b.p[i];
    }
    map_->sum_all(std::span(all.data(), static_cast<std::size_t>(all.size())));
    const Eigen::VectorXd y = factor_.solve(all);
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t c = 0; c < 3; ++c) x.u[GridVector::width * i + c] = y[here(i, c)];
      x.p[i] = y[here(i, 3)];
    }
  }
  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(factor_.matrixL().nestedExpression().nonZeros()) *
           (sizeof(double) + sizeof(int));
  }

 private:
  const IndexMap* map_;
  std::size_t rows_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace kacanov
