// SPDX-License-Identifier: BSD-3-Clause
// A level of rigid-body modes that needs no body, with sums over its ranks.
#pragma once

#include <mpi.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <kacanov/part.hpp>
#include "multigrid/aggregation/block_matrix.hpp"

namespace kacanov::testing {

/// A chain of springs with `rows` rows per rank, connected across the ranks; each block is 6 × 6 and positive
/// definite.
inline BlockMatrix<6> chain(std::int32_t rows) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const std::int64_t first = static_cast<std::int64_t>(rank) * rows,
                     total = static_cast<std::int64_t>(ranks) * rows;
  std::vector<Vector3> centres;
  BlockSums<6> sums;
  for (std::int64_t i = first; i < first + rows; ++i) {
    centres.push_back({static_cast<double>(i), 0.1 * static_cast<double>(i % 3), 0.0});
    for (std::size_t k = 0; k < 6; ++k) {
      sums.at(i, i)[7 * k] += 2.5 + 0.1 * static_cast<double>(k);
      // Each rank also adds to rows of the next rank.
      if (i + 1 < total) sums.at(i, i + 1)[7 * k] -= 1.0;
      if (i + 1 < total) sums.at(i + 1, i + 1)[7 * k] += 0.25;
    }
    if (i + 1 < total) sums.at(i, i + 1)[1] = 0.125;
  }
  return {std::move(centres), std::move(sums), mpi_communicator(MPI_COMM_WORLD)};
}

inline double sum_all(double v) {
  MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return v;
}

inline double dot(const std::vector<double>& x, const std::vector<double>& y, std::size_t n) {
  return sum_all(std::inner_product(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n), y.begin(), 0.0));
}

template <int M>
std::vector<double> wave(const BlockMatrix<M>& level, double frequency) {
  std::vector<double> x(level.size(), 0.0);
  for (std::size_t i = 0; i < level.owned_size(); ++i)
    x[i] = std::sin(frequency * static_cast<double>(level.first() * M + static_cast<std::int64_t>(i)) + 0.3);
  return x;
}

}  // namespace kacanov::testing
