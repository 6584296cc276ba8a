// SPDX-License-Identifier: BSD-3-Clause
// Largest eigenvalues of a distributed symmetric operator: ARPACK in reverse communication.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kacanov {

/// When an estimate stops (theory: lanczos).
struct LanczosOptions {
  double tolerance = 1e-2;  ///< Ritz bound relative to the value
  int wanted = 1;           ///< how many of the largest
  int basis = 0;            ///< vectors kept beyond `wanted`; 0: 7, or 19 where the tolerance is below 1e-3
  int max_products = 500;
};

struct LanczosResult {
  std::vector<double> values;  ///< descending, `wanted` at the most
  std::vector<double> bounds;  ///< absolute Ritz residual bounds: of the product as it is computed
  /// Own entries of the unit vector of each value; none where it has not converged.
  std::vector<std::vector<double>> vectors;
  int products = 0;
  bool converged = false;
};

/// y = K x on the entries this rank owns (possibly none). Collective.
using Product = std::function<void(std::span<const double> x, std::span<double> y)>;

/// The largest eigenvalues of a symmetric operator, with bounds. `index` numbers this rank's entries over all
/// ranks, so that the start vector does not depend on the partition. Small operators (up to 24 rows in all)
/// are formed column by column and solved densely: there ARPACK has no room to work, and breaks down on K =
/// c·I. Throws InternalError where ARPACK fails. Collective.
LanczosResult largest_eigenvalues(const Product& product, std::span<const std::int64_t> index, MPI_Comm comm,
                                  const LanczosOptions& options);

}  // namespace kacanov
