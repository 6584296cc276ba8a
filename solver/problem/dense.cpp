// SPDX-License-Identifier: BSD-3-Clause
// Decompositions of small dense matrices.
#include "problem/dense.hpp"

#include <Eigen/Dense>

namespace kacanov {

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a, double threshold) {
  if (a.size() == 0) return Eigen::MatrixXd::Zero(a.cols(), a.rows());
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(threshold);
  return decomposition.compute(a).pseudoInverse();
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& a) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ() *
         Eigen::MatrixXd::Identity(a.rows(), a.cols());
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& a) { return a.inverse(); }

}  // namespace kacanov
