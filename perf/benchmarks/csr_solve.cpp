// SPDX-License-Identifier: BSD-3-Clause
// Linear solve with an assembled matrix, for comparison: compressed rows, conjugate gradients, Jacobi
// preconditioner.
#include "csr_solve.hpp"

#include <cmath>

namespace {

double dot(std::span<const double> x, std::span<const double> y, int threads) {
  double sum = 0.0;
#pragma omp parallel for num_threads(threads) reduction(+ : sum)
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

}  // namespace

int solve_by_diagonal(const CsrMatrix& matrix, std::span<const double> b, std::span<double> x,
                      double relative, int threads) {
  const std::size_t n = b.size();
  std::vector<double> r(b.begin(), b.end()), z(n), p(n, 0.0), q(n), scale(n, 1.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = matrix.first[i]; k < matrix.first[i + 1]; ++k)
      if (static_cast<std::size_t>(matrix.column[k]) == i) scale[i] = 1.0 / matrix.value[k];
  const double goal = relative * std::sqrt(dot(b, b, threads));
  double rz = 1.0;
  int iterations = 0;
  for (; iterations < 20000 && std::sqrt(dot(r, r, threads)) > goal; ++iterations) {
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) z[i] = scale[i] * r[i];
    const double rz_new = dot(r, z, threads), beta = iterations == 0 ? 0.0 : rz_new / rz;
    rz = rz_new;
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::int64_t k = matrix.first[i]; k < matrix.first[i + 1]; ++k)
        sum += matrix.value[k] * p[matrix.column[k]];
      q[i] = sum;
    }
    const double alpha = rz / dot(p, q, threads);
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
  }
  return iterations;
}
