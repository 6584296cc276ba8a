// SPDX-License-Identifier: BSD-3-Clause
// Direct solve of the last level of the multigrid.
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <span>
#include <vector>

#include <kacanov/error.hpp>
#include "multigrid/rigid_level.hpp"

namespace kacanov {

/// A sparse factorisation of the last level, the same on every rank.
template <int M>
class DirectSolve {
 public:
  /// Throws InternalError if the matrix is not definite. The level must outlive it. Collective.
  explicit DirectSolve(const RigidLevel<M>& level) : level_(&level) {
    const auto size = static_cast<Eigen::Index>(level.total()) * M;
    std::vector<Eigen::Triplet<double>> triplets;
    std::vector<double> diagonal(size, 0.0);
    for (const auto& entry : level.gathered())
      for (int i = 0; i < M; ++i)
        for (int j = 0; j < M; ++j) {
          const auto row = static_cast<Eigen::Index>(entry.row) * M + i,
                     column = static_cast<Eigen::Index>(entry.column) * M + j;
          const double v = entry.block[i * M + j];
          triplets.emplace_back(row, column, v);
          if (row == column) diagonal[row] += v;
        }
    // For modes that boundary conditions remove, and for rounding: a shift far below all stiffnesses, unless
    // penalties that dominate the body's stiffness require a larger one.
    const double largest = diagonal.empty() ? 1.0 : *std::max_element(diagonal.begin(), diagonal.end());
    Eigen::SparseMatrix<double> matrix(size, size), unit(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    unit.setIdentity();
    for (double shift = 1e-10; shift < 1e-3; shift *= 100.0) {
      factor_.compute(matrix + (largest > 0.0 ? shift * largest : 1.0) * unit);
      if (factor_.info() == Eigen::Success) return;
    }
    throw InternalError("the coarsest matrix of the preconditioner is not definite");
  }
  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(factor_.matrixL().nestedExpression().nonZeros()) *
           (sizeof(double) + sizeof(int));
  }
  /// x = A⁻¹ b on owned rows, M entries per row. Collective.
  void solve(std::span<const double> b, std::span<double> x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(level_->total()) * M);
    const auto at = static_cast<Eigen::Index>(level_->first()) * M;
    const auto owned = static_cast<Eigen::Index>(level_->owned_size());
    for (Eigen::Index i = 0; i < owned; ++i) all[at + i] = b[i];
    level_->map().sum_all(std::span(all.data(), all.size()));
    const Eigen::VectorXd y = factor_.solve(all);
    for (Eigen::Index i = 0; i < owned; ++i) x[i] = y[at + i];
  }

 private:
  const RigidLevel<M>* level_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace kacanov
