// SPDX-License-Identifier: BSD-3-Clause
// Dense matrices of small problems on one rank: what the solver never forms.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov::testing {

/// B(g), boundary conditions left out.
Eigen::MatrixXd dense_stiffness(const Part& part, std::span<const double> g);

/// Rows of M^½ N, or of M^½ [N; T] with `friction`.
Eigen::MatrixXd dense_traces(const Part& part, bool friction);

std::vector<int> free_components(const Part& part);

/// Eigenvalues of K = C B⁻¹ Cᵀ that are not zero, ascending; C from dense_traces.
Eigen::VectorXd dense_spectrum(const Part& part, bool friction);

}  // namespace kacanov::testing
