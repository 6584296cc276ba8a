// SPDX-License-Identifier: BSD-3-Clause
// Dense decompositions by Eigen, for tests.
#include "dense_algebra.hpp"

#include <Eigen/Dense>
#include <random>

namespace kacanov::testing {

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& right) {
  return a.ldlt().solve(right);
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (a + a.transpose()), Eigen::EigenvaluesOnly)
      .eigenvalues();
}

Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  const Eigen::Index n = values.size();
  const Eigen::MatrixXd random = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(engine); });
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ();
  return q * values.asDiagonal() * q.transpose();
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a * b; }

Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& a, const Eigen::MatrixXd& rows) {
  return rows * solve_symmetric(a, rows.transpose());
}

}  // namespace kacanov::testing
