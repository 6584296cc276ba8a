// SPDX-License-Identifier: BSD-3-Clause
// Lanczos on matrices with known eigenvalues, their rows distributed arbitrarily over the ranks.
#include "spectrum/lanczos.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <random>

#include "../dense_algebra.hpp"

using namespace kacanov;
using testing::with_eigenvalues;

namespace {

/// Returns the largest eigenvalues of k, its rows distributed over the ranks; with `first_rank_idle` rank 0
/// has none.
LanczosResult largest(const Eigen::MatrixXd& k, const LanczosOptions& options, bool first_rank_idle) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const int workers = first_rank_idle && ranks > 1 ? ranks - 1 : ranks, place = rank - (ranks - workers);
  const int n = static_cast<int>(k.rows());
  const int first = place < 0 ? 0 : n * place / workers, end = place < 0 ? 0 : n * (place + 1) / workers;
  std::vector<std::int64_t> index;
  for (int i = first; i < end; ++i) index.push_back(i);
  const Product product = [&](std::span<const double> x, std::span<double> y) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < x.size(); ++i) all(first + static_cast<int>(i)) = x[i];
    MPI_Allreduce(MPI_IN_PLACE, all.data(), n, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = k.row(first + static_cast<int>(i)).dot(all);
  };
  return largest_eigenvalues(product, index, MPI_COMM_WORLD, options);
}

/// Checks that the largest eigenvalues are within the tolerance and, up to rounding, within their error
/// bounds.
void check_largest(const Eigen::VectorXd& values, int wanted, double tolerance) {
  const Eigen::MatrixXd k = with_eigenvalues(values);
  Eigen::VectorXd sorted = values;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  for (const bool idle : {false, true}) {
    const LanczosResult found = largest(k, {tolerance, wanted, 2000}, idle);
    CAPTURE(values.size());
    CAPTURE(idle);
    CHECK(found.converged);
    const int expected = std::min(wanted, static_cast<int>(values.size()));
    REQUIRE(found.values.size() == static_cast<std::size_t>(expected));
    for (int i = 0; i < expected; ++i) {
      const std::size_t at = i;
      CHECK(found.values[at] == doctest::Approx(sorted(i)).epsilon(tolerance + 1e-12));
      // Every Ritz value lies within its bound of an eigenvalue.
      const double nearest = (values.array() - found.values[at]).abs().minCoeff();
      CHECK(nearest <= found.bounds[at] + 1e-12 * sorted(0));
    }
  }
}

}  // namespace

TEST_CASE("the largest eigenvalue of small and large matrices") {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  for (const int n : {1, 2, 3, 24, 25, 26, 40, 120}) {
    Eigen::VectorXd values = Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(engine); });
    values(0) = 1.5;
    check_largest(values, 1, 1e-10);
    check_largest(values, 1, 1e-2);
  }
}

TEST_CASE("several eigenvalues, clustered ones among them") {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(80, 0.01, 1.0);
  values(10) = 3.0;
  values(20) = 3.0 - 1e-7;
  values(30) = 2.5;
  check_largest(values, 1, 1e-8);
  check_largest(values, 3, 1e-10);
}

TEST_CASE("a multiple of the identity, where Lanczos breaks down at once") {
  for (const int n : {1, 2, 25, 60}) check_largest(Eigen::VectorXd::Constant(n, 4.25), 1, 1e-9);
}

TEST_CASE("few distinct eigenvalues exhaust the Krylov space early") {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(50, 1.0);
  values.tail(20).setConstant(2.0);
  check_largest(values, 1, 1e-9);
}

TEST_CASE("no rows at all") {
  const LanczosResult found = largest(Eigen::MatrixXd(0, 0), {}, false);
  CHECK(found.values.empty());
  CHECK(found.products == 0);
}
