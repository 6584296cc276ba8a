// SPDX-License-Identifier: BSD-3-Clause
// What a code does that has a matrix: compressed rows, conjugate gradients, the diagonal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

struct CsrMatrix {
  std::vector<std::int64_t> first;  ///< rows + 1
  std::vector<std::int32_t> column;
  std::vector<double> value;
};

/// Solves A x = b from zero to |r| ≤ relative |b| on OpenMP's threads. Returns the iterations.
int solve_by_diagonal(const CsrMatrix& matrix, std::span<const double> b, std::span<double> x,
                      double relative, int threads);
