// SPDX-License-Identifier: BSD-3-Clause
// The ranks that work together, and reductions over them.
#include <kacanov/communicator.hpp>

#include <vector>

namespace kacanov {

double Communicator::sum_all(double value) const {
  if (ranks > 1) transport->sum(std::span(&value, 1));
  return value;
}

void Communicator::sum_all(std::span<double> values) const {
  if (ranks > 1) transport->sum(values);
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
  if (ranks > 1) transport->max(std::span(&value, 1));
  return value;
}

void Communicator::max_all(std::span<double> values) const {
  if (ranks > 1) transport->max(values);
}

std::int64_t Communicator::sum_all(std::int64_t value) const {
  if (ranks > 1) transport->sum(std::span(&value, 1));
  return value;
}

std::int64_t Communicator::sum_below(std::int64_t value) const {
  return ranks > 1 ? transport->sum_below(value) : 0;
}

}  // namespace kacanov
