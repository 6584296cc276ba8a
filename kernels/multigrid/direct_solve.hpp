// SPDX-License-Identifier: BSD-3-Clause
// Direct solve of the last level of the multigrid.
#pragma once

#include <Eigen/SparseCholesky>
#include <span>
#include <vector>

#include <kacanov/communicator.hpp>
#include <kacanov/error.hpp>

namespace kacanov {

/// The whole matrix of the last level, the same on every rank, and this rank's range of its unknowns.
struct LastMatrix {
  Eigen::Index first = 0, owned = 0, total = 0;
  std::vector<Eigen::Triplet<double>> entries;
  /// Per unknown: its kind's largest diagonal entry, with the sign of the definite block that it is in.
  std::vector<double> scale;
};

/// A sparse factorisation of it. `Factor`: L Lᵀ for definite matrices, L D Lᵀ for [A Bᵀ; B −C], which has one
/// for any order of the unknowns if A and C are definite (Vanderbei, SIAM J. Optim. 5 (1995) 100–113).
template <class Factor>
class DirectSolve {
 public:
  /// Throws InternalError if there is no factor. The communicator must outlive it. Collective.
  DirectSolve(const LastMatrix& last, const Communicator& comm)
      : comm_(&comm), first_(last.first), owned_(last.owned), total_(last.total) {
    Eigen::SparseMatrix<double> matrix(total_, total_), shift(total_, total_);
    matrix.setFromTriplets(last.entries.begin(), last.entries.end());
    // For unknowns that move no node, and for rounding: a shift far below all stiffnesses, unless penalties
    // that dominate the body's stiffness require a larger one.
    for (double share = 1e-10; share < 1e-3; share *= 100.0) {
      shift.setIdentity();
      for (Eigen::Index i = 0; i < total_; ++i)
        shift.coeffRef(i, i) = share * last.scale[static_cast<std::size_t>(i)];
      factor_.compute(matrix + shift);
      if (factor_.info() == Eigen::Success) return;
    }
    throw InternalError("the coarsest matrix of the preconditioner has no factor");
  }

  /// x = A⁻¹ b on this rank's unknowns. Collective.
  template <class Real>
  void solve(std::span<const Real> b, std::span<Real> x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(total_);
    for (Eigen::Index i = 0; i < owned_; ++i)
      all[first_ + i] = static_cast<double>(b[static_cast<std::size_t>(i)]);
    comm_->sum_all(std::span(all.data(), static_cast<std::size_t>(total_)));
    const Eigen::VectorXd y = factor_.solve(all);
    for (Eigen::Index i = 0; i < owned_; ++i)
      x[static_cast<std::size_t>(i)] = static_cast<Real>(y[first_ + i]);
  }
  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(factor_.matrixL().nestedExpression().nonZeros()) *
           (sizeof(double) + sizeof(int));
  }

 private:
  const Communicator* comm_;
  Eigen::Index first_, owned_, total_;
  Factor factor_;
};

using DefiniteSolve = DirectSolve<Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>>;
using SaddlePointSolve = DirectSolve<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>;

}  // namespace kacanov
