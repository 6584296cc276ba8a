// SPDX-License-Identifier: BSD-3-Clause
// Direct solve on the last grid of displacements and pressures.
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <kacanov/error.hpp>
#include "multigrid/leaf_form.hpp"

namespace kacanov {

/// A factorisation L D Lᵀ of [A Bᵀ; B −C], the same on every rank: with A and C definite it exists for any
/// order of the unknowns (Vanderbei, SIAM J. Optim. 5 (1995) 100–113).
class PressureDirect {
 public:
  /// `leaves`: of the level of the vertices. Throws InternalError if the factorisation fails. The
  /// communicator must outlive it. Collective.
  PressureDirect(const GridVertices& vertices, const GridLeaves& leaves, const LevelMoments& moments,
                 const Communicator& comm)
      : comm_(&comm),
        first_(static_cast<std::size_t>(vertices.starts()[comm.rank])),
        rows_(static_cast<std::size_t>(vertices.starts()[comm.rank + 1]) - first_),
        total_(static_cast<std::size_t>(vertices.starts().back())) {
    const auto size = static_cast<Eigen::Index>(4 * total_);
    std::vector<Eigen::Triplet<double>> triplets;
    double stiffest = 0.0, softest = 0.0;
    for (const WholeLeaf& leaf : whole_leaves(vertices, leaves, moments, comm)) {
      const LeafForm form(leaf.moments, &leaf.stiffness,
                          vertices.tree().length(vertices.tree().cells()[leaf.cell]));
      for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t j = 0; j < 8; ++j)
          for (const auto& row : vertices.corner(leaf.cell, i))
            for (const auto& column : vertices.corner(leaf.cell, j))
              for (int k = 0; k < 16; ++k) {
                const double v = row.weight * column.weight * form.block(i, j)[static_cast<std::size_t>(k)];
                triplets.emplace_back(4 * row.row + k / 4, 4 * column.row + k % 4, v);
              }
    }
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    for (Eigen::Index i = 0; i < size; ++i) {
      double& scale = i % 4 < 3 ? stiffest : softest;
      scale = std::max(scale, std::abs(matrix.coeff(i, i)));
    }
    // For unknowns that move no node, and for rounding: shifts far below all entries, towards definiteness.
    for (Eigen::Index i = 0; i < size; ++i)
      matrix.coeffRef(i, i) += i % 4 < 3 ? 1e-10 * stiffest : -1e-10 * softest;
    factor_.compute(matrix);
    if (factor_.info() != Eigen::Success)
      throw InternalError("the coarsest matrix of the preconditioner has no factor");
  }

  /// Solves for x with the right-hand side b, four values per row. Collective.
  void solve(std::span<const float> b, std::span<float> x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(4 * total_));
    for (std::size_t i = 0; i < 4 * rows_; ++i)
      all[static_cast<Eigen::Index>(4 * first_ + i)] = static_cast<double>(b[i]);
    comm_->sum_all(std::span(all.data(), static_cast<std::size_t>(all.size())));
    const Eigen::VectorXd y = factor_.solve(all);
    for (std::size_t i = 0; i < 4 * rows_; ++i)
      x[i] = static_cast<float>(y[static_cast<Eigen::Index>(4 * first_ + i)]);
  }
  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(factor_.matrixL().nestedExpression().nonZeros()) *
           (sizeof(double) + sizeof(int));
  }

 private:
  struct WholeLeaf {
    std::int32_t cell;
    LeafMoments moments;
    StiffnessMoments stiffness;
  };
  /// All leaves of the level, summed over all ranks.
  static std::vector<WholeLeaf> whole_leaves(const GridVertices& vertices, const GridLeaves& leaves,
                                             const LevelMoments& moments, const Communicator& comm) {
    std::vector<WholeLeaf> all;
    const auto mine = leaves.cell.begin();
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(vertices.tree().cells().size()); ++c) {
      if (!vertices.tree().is_leaf(c, vertices.level())) continue;
      WholeLeaf& whole = all.emplace_back(WholeLeaf{c, {}, {}});
      const auto at = std::lower_bound(mine, leaves.cell.end(), c);
      if (at == leaves.cell.end() || *at != c) continue;
      const auto leaf = static_cast<std::size_t>(at - mine);
      whole.moments = moments.leaf[leaf];
      if (moments.stiff[leaf] >= 0) whole.stiffness = moments.stiffness[moments.stiff[leaf]];
    }
    const auto each = [&](const auto& visit) {
      for (WholeLeaf& leaf : all) {
        for (Moments* m :
             {&leaf.moments.shear, &leaf.moments.bulk, &leaf.moments.volume, &leaf.moments.compliance})
          for (double& v : *m) visit(v);
        for (Moments& m : leaf.stiffness)
          for (double& v : m) visit(v);
      }
    };
    std::vector<double> sums;
    each([&](double v) { sums.push_back(v); });
    comm.sum_all(sums);
    std::size_t k = 0;
    each([&](double& v) { v = sums[k++]; });
    return all;
  }

  const Communicator* comm_;
  std::size_t first_, rows_, total_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace kacanov
