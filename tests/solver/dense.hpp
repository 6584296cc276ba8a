// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices of small problems on one rank, which the solver itself never forms.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov::testing {

/// Returns B(g) without boundary conditions.
Eigen::MatrixXd dense_stiffness(const Part& part, std::span<const double> g);

/// Returns the rows of M^½ N, or of M^½ [N; T] with `friction`.
Eigen::MatrixXd dense_traces(const Part& part, bool friction);

std::vector<int> free_components(const Part& part);

/// Returns the nonzero eigenvalues of K = C B⁻¹ Cᵀ in ascending order, with C from dense_traces.
Eigen::VectorXd dense_spectrum(const Part& part, bool friction);

}  // namespace kacanov::testing
