// SPDX-License-Identifier: BSD-3-Clause
// Decompositions of small dense matrices: compiles each Eigen decomposition once for the whole solver.
#pragma once

#include <Eigen/Core>

namespace kacanov {

/// Returns the Moore–Penrose inverse of `a` (any shape, also empty). Pivots below `threshold` times the
/// largest count as zero.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a, double threshold);

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< orthonormal columns, in the order of the values
};

/// Returns eigenvalues and eigenvectors of a symmetric matrix; reads the lower triangle only.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

/// Returns an orthonormal basis of the column space of `a`; the columns must be linearly independent.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& a);

/// Returns the inverse of a regular square matrix.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

}  // namespace kacanov
