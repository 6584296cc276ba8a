// SPDX-License-Identifier: BSD-3-Clause
// The ranks that work together, and reductions over them.
#include <kacanov/communicator.hpp>

#include <vector>

namespace kacanov {

Communicator::Communicator(MPI_Comm of) : comm(of) {
  MPI_Comm_rank(of, &rank);
  MPI_Comm_size(of, &ranks);
}

double Communicator::sum_all(double value) const {
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, comm);
  return value;
}

void Communicator::sum_all(std::span<double> values) const {
  if (ranks > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, comm);
}

void Communicator::sum_each(std::initializer_list<double*> numbers) const {
  if (ranks == 1) return;
  std::vector<double> sums;
  for (const double* number : numbers) sums.push_back(*number);
  sum_all(sums);
  auto sum = sums.begin();
  for (double* number : numbers) *number = *sum++;
}

double Communicator::max_all(double value) const {
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm);
  return value;
}

void Communicator::max_all(std::span<double> values) const {
  if (ranks > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX, comm);
}

std::int64_t Communicator::sum_all(std::int64_t value) const {
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, comm);
  return value;
}

std::int64_t Communicator::sum_below(std::int64_t value) const {
  std::int64_t below = 0;
  if (ranks > 1) MPI_Exscan(&value, &below, 1, MPI_INT64_T, MPI_SUM, comm);
  return rank == 0 ? 0 : below;
}

}  // namespace kacanov
