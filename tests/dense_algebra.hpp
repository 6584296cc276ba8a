// SPDX-License-Identifier: BSD-3-Clause
// Dense matrix algebra for tests, compiled once because each of Eigen's decompositions takes seconds to
// compile.
#pragma once

#include <Eigen/Core>

namespace kacanov::testing {

/// Returns A⁻¹ R for a symmetric, nonsingular A.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& right);

/// Returns the eigenvalues of a symmetric matrix in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// Returns a symmetric matrix with the given eigenvalues, the same one on every call.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values);

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// Returns A B.
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns R A⁻¹ Rᵀ for a symmetric, nonsingular A.
Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& a, const Eigen::MatrixXd& rows);

}  // namespace kacanov::testing
