// SPDX-License-Identifier: BSD-3-Clause
// Largest eigenvalues of a distributed symmetric operator by ARPACK in reverse communication.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kacanov {

/// Stopping criteria of an estimate (theory: lanczos).
struct LanczosOptions {
  double tolerance = 1e-2;  ///< Ritz bound relative to the eigenvalue
  int wanted = 1;           ///< number of largest eigenvalues
  int basis = 0;            ///< basis vectors beyond `wanted`; 0: 7, or 19 for tolerances below 1e-3
  int max_products = 500;
};

struct LanczosResult {
  std::vector<double> values;  ///< descending, at most `wanted`
  std::vector<double> bounds;  ///< absolute Ritz residual bounds, with respect to the product as computed
  /// This rank's entries of the unit vector of each value; empty without convergence.
  std::vector<std::vector<double>> vectors;
  int products = 0;
  bool converged = false;
};

/// y = K x on the entries this rank owns (possibly none). Collective.
using Product = std::function<void(std::span<const double> x, std::span<double> y)>;

/// Computes the largest eigenvalues of a symmetric operator, with bounds. `index`: global numbers of this
/// rank's entries; the start vector depends on them, not on the partition. Up to 24 rows in total are solved
/// densely: ARPACK has no room there and fails on K = c·I. Throws InternalError if ARPACK fails. Collective.
LanczosResult largest_eigenvalues(const Product& product, std::span<const std::int64_t> index, MPI_Comm comm,
                                  const LanczosOptions& options);

}  // namespace kacanov
