// SPDX-License-Identifier: BSD-3-Clause
// Linear solve with an assembled matrix, for comparison: compressed rows, conjugate gradients, Jacobi
// preconditioner.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

struct CsrMatrix {
  std::vector<std::int64_t> first;  ///< rows + 1 entries
  std::vector<std::int32_t> column;
  std::vector<double> value;
};

/// Solves A x = b from x = 0 to |r| ≤ relative |b| on OpenMP's threads. Returns the number of iterations.
int solve_by_diagonal(const CsrMatrix& matrix, std::span<const double> b, std::span<double> x,
                      double relative, int threads);
