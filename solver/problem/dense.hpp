// SPDX-License-Identifier: BSD-3-Clause
// Decompositions of small dense matrices, each of Eigen's compiled once for all rooms of the solver.
#pragma once

#include <Eigen/Core>

namespace kacanov {

/// The Moore–Penrose inverse of `a` (any shape, empty ones too). Pivots below `threshold` times the largest
/// are zero.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a, double threshold);

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< orthonormal columns, in the order of the values
};

/// Eigenvalues and eigenvectors of a symmetric matrix, of which the lower triangle is read.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

/// An orthonormal basis of what the columns of `a` span; they have to be independent.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& a);

/// The inverse of a square matrix that has one.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

}  // namespace kacanov
