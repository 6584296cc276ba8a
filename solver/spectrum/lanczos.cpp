// SPDX-License-Identifier: BSD-3-Clause
// Largest eigenvalues of a distributed symmetric operator by ARPACK in reverse communication.
#include "spectrum/lanczos.hpp"

#include <parpack.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <kacanov/error.hpp>
#include <kacanov/part.hpp>

namespace kacanov {
namespace {

constexpr std::int64_t dense_rows = 24;

/// Returns a number in (−1, 1) that depends on the row's index only, so not on the partition.
double start_entry(std::int64_t index) {
  auto z = static_cast<std::uint64_t>(index) + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1.0p-52 - 1.0;
}

LanczosResult dense(const Product& product, std::span<const std::int64_t> index, std::int64_t rows,
                    const Communicator& ranks, const LanczosOptions& options) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(rows, rows);
  const std::int64_t offset = ranks.sum_below(static_cast<std::int64_t>(index.size()));

  LanczosResult result;
  std::vector<double> x(index.size()), y(index.size());
  for (std::int64_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = offset + static_cast<std::int64_t>(i) == j ? 1.0 : 0.0;
    product(x, y);
    ++result.products;
    for (std::size_t i = 0; i < y.size(); ++i) k(offset + static_cast<std::int64_t>(i), j) = y[i];
  }
  ranks.sum_all(std::span(k.data(), static_cast<std::size_t>(k.size())));
  const Eigen::MatrixXd symmetric = 0.5 * (k + k.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  const double asymmetry = 0.5 * (k - k.transpose()).norm();
  for (std::int64_t i = 0; i < std::min<std::int64_t>(options.wanted, rows); ++i) {
    result.values.push_back(solver.eigenvalues()(rows - 1 - i));
    result.bounds.push_back(asymmetry);
    const Eigen::VectorXd vector =
        solver.eigenvectors().col(rows - 1 - i).segment(offset, static_cast<Eigen::Index>(index.size()));
    result.vectors.emplace_back(vector.begin(), vector.end());
  }
  result.converged = true;
  return result;
}

}  // namespace

LanczosResult largest_eigenvalues(const Product& product, std::span<const std::int64_t> index, MPI_Comm comm,
                                  const LanczosOptions& options) {
  const Communicator ranks = mpi_communicator(comm);
  const std::int64_t rows = ranks.sum_all(static_cast<std::int64_t>(index.size()));
  LanczosResult result;
  result.converged = rows == 0;
  if (rows == 0) return result;
  if (rows <= dense_rows) return dense(product, index, rows, ranks, options);

  // PARPACK rejects ranks without rows: such a rank gets one row of zeros, which adds the eigenvalue 0.
  const std::size_t own = index.size();
  const auto n = static_cast<a_int>(std::max<std::size_t>(own, 1));
  const std::size_t length = n;
  const a_int wanted = options.wanted;
  // ARPACK tests convergence only after a full basis, so a loose tolerance calls for a short one.
  const int extra = options.basis > 0 ? options.basis : options.tolerance >= 1e-3 ? 7 : 19;
  const a_int basis = std::min<a_int>(static_cast<a_int>(rows), wanted + extra);
  std::vector<double> residual(length, 0.0), v(length * static_cast<std::size_t>(basis)),
      work(3 * length, 0.0);
  for (std::size_t i = 0; i < own; ++i) residual[i] = start_entry(index[i]);
  const a_int space = basis * (basis + 8);
  std::vector<double> values_work(space);
  std::array<a_int, 11> parameters{};
  std::array<a_int, 14> pointers{};
  parameters[0] = 1;  // exact shifts
  parameters[2] = std::max(1, options.max_products / std::max(1, static_cast<int>(basis - wanted)));
  parameters[3] = 1;
  parameters[6] = 1;  // standard problem
  const MPI_Fint fortran_comm = MPI_Comm_c2f(comm);
  a_int task = 0, info = 1;  // info 1: use our start vector
  while (true) {
    ranks.expect_all_here();
    pdsaupd_c(fortran_comm, &task, "I", n, "LA", wanted, options.tolerance, residual.data(), basis, v.data(),
              n, parameters.data(), pointers.data(), work.data(), values_work.data(), space, &info);
    if (task != 1 && task != -1) break;
    double* x = work.data() + pointers[0] - 1;
    double* y = work.data() + pointers[1] - 1;
    std::fill(y, y + length, 0.0);
    product(std::span<const double>(x, own), std::span<double>(y, own));
    ++result.products;
  }
  // info 1: the iteration limit; 3: no shifts could be applied. Both leave usable values with their bounds.
  if (info < 0) throw InternalError("ARPACK pdsaupd failed with info " + std::to_string(info));
  result.converged = info == 0;
  const std::size_t ritz = pointers[5] - 1, bounds = static_cast<std::size_t>(pointers[6] - 1);
  std::vector<std::pair<double, double>> found;
  for (std::size_t i = 0; i < static_cast<std::size_t>(basis); ++i)
    found.emplace_back(values_work[ritz + i], std::abs(values_work[bounds + i]));
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < static_cast<std::size_t>(wanted); ++i) {
    result.values.push_back(found[i].first);
    result.bounds.push_back(found[i].second);
  }
  if (info != 0) return result;
  std::vector<a_int> select(static_cast<std::size_t>(basis));
  std::vector<double> values(static_cast<std::size_t>(wanted));
  pdseupd_c(fortran_comm, 1, "A", select.data(), values.data(), v.data(), n, 0.0, "I", n, "LA", wanted,
            options.tolerance, residual.data(), basis, v.data(), n, parameters.data(), pointers.data(),
            work.data(), values_work.data(), space, &info);
  if (info != 0) throw InternalError("ARPACK pdseupd failed with info " + std::to_string(info));
  for (std::size_t i = values.size(); i-- > 0;) {  // ascending
    const auto first = v.begin() + static_cast<std::ptrdiff_t>(i * length);
    result.vectors.emplace_back(first, first + static_cast<std::ptrdiff_t>(own));
  }
  return result;
}

}  // namespace kacanov
