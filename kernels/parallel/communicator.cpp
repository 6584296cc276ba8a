// SPDX-License-Identifier: BSD-3-Clause
// The communicator: the ranks that work together, and reductions over them.
#include <kacanov/communicator.hpp>

#ifdef KACANOV_CHECK_COLLECTIVES
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#endif
#include <vector>

namespace kacanov {

#ifdef KACANOV_CHECK_COLLECTIVES
void Communicator::expect_all_here(CallSite at, std::int64_t entries) const {
  if (ranks == 1) return;
  using Place = std::array<char, 160>;
  // The last two parts of a path identify a file, and are the same in builds in different folders.
  std::string_view file = at.file;
  if (const auto slash = file.rfind('/'); slash != file.npos && slash > 0)
    if (const auto folder = file.rfind('/', slash - 1); folder != file.npos) file.remove_prefix(folder + 1);
  Place here{};
  std::snprintf(here.data(), here.size(), "%.*s:%d (%s, %lld entries)", static_cast<int>(file.size()),
                file.data(), at.line, at.function, static_cast<long long>(entries));
  // Compare a hash first: it is cheaper than a text and usually enough.
  const auto hash = static_cast<std::int64_t>(std::hash<std::string_view>()(here.data()));
  const std::vector<std::int64_t> hashes = transport->all(hash);
  if (std::count(hashes.begin(), hashes.end(), hash) == ranks) return;
  std::vector<Place> places(ranks);
  transport->gather(here.data(), places.data(), {std::vector<int>(ranks, 1), sizeof(Place)});
  const auto other =
      std::find_if(places.begin(), places.end(), [&](const Place& p) { return p != places[0]; });
  throw std::logic_error("ranks do not take part in the same collective call: rank 0 is at " +
                         std::string(places[0].data()) + ", rank " + std::to_string(other - places.begin()) +
                         " at " + other->data());
}
#endif

double Communicator::sum_all(double value, CallSite at) const {
  sum_all(std::span(&value, 1), at);
  return value;
}

void Communicator::sum_all(std::span<double> values, CallSite at) const {
  expect_all_here(at, static_cast<std::int64_t>(values.size()));
  if (ranks > 1) transport->sum(values);
}

void Communicator::sum_each(std::initializer_list<double*> numbers, CallSite at) const {
  if (ranks == 1) return;
  std::vector<double> sums;
  for (const double* number : numbers) sums.push_back(*number);
  sum_all(sums, at);
  auto sum = sums.begin();
  for (double* number : numbers) *number = *sum++;
}

double Communicator::max_all(double value, CallSite at) const {
  max_all(std::span(&value, 1), at);
  return value;
}

void Communicator::max_all(std::span<double> values, CallSite at) const {
  expect_all_here(at, static_cast<std::int64_t>(values.size()));
  if (ranks > 1) transport->max(values);
}

std::int64_t Communicator::sum_all(std::int64_t value, CallSite at) const {
  expect_all_here(at, 1);
  if (ranks > 1) transport->sum(std::span(&value, 1));
  return value;
}

std::int64_t Communicator::sum_below(std::int64_t value, CallSite at) const {
  expect_all_here(at, 1);
  return ranks > 1 ? transport->sum_below(value) : 0;
}

}  // namespace kacanov
