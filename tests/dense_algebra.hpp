// SPDX-License-Identifier: BSD-3-Clause
// What tests ask of dense matrices, compiled once: each of Eigen's decompositions takes seconds to compile.
#pragma once

#include <Eigen/Core>

namespace kacanov::testing {

/// A⁻¹ R of a symmetric A that has an inverse.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& right);

/// Eigenvalues of a symmetric matrix, ascending.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// A symmetric matrix with given eigenvalues; the same each time.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values);

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// A B.
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// R A⁻¹ Rᵀ of a symmetric A that has an inverse.
Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& a, const Eigen::MatrixXd& rows);

}  // namespace kacanov::testing
