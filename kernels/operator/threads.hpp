// SPDX-License-Identifier: BSD-3-Clause
// Thread teams of a library inside a host process: own threads or OpenMP's, availability, and fork().
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace kacanov {

/// Starts the calling thread's team of `threads` threads, so that the loops find it running. The threads are
/// the library's own, or OpenMP's if the environment variable KACANOV_THREADS is "openmp"; the choice then
/// holds for the whole process. Throws std::invalid_argument for values other than "openmp" and "own",
/// std::system_error if the system does not grant this many threads.
void start_team(int threads);

/// Returns whether this process was created by fork() after an operator: the threads of its parent's teams do
/// not exist in it.
bool is_forked_child() noexcept;

/// Calls run(t) once for every t < threads, on the calling thread and its team: sequentially if there is no
/// team, as within such a call. Results do not depend on the assignment of calls to threads. An exception is
/// rethrown after all calls have finished.
void in_team(int threads, const std::function<void(int)>& run);

/// Calls work(begin, end) for the threads' shares of 0 … n − 1; directly if n is too small to wake other
/// threads.
template <class Work>
void in_shares(int threads, std::size_t n, const Work& work) {
  constexpr std::size_t worth = 2048;
  if (threads == 1 || n < worth) return work(std::size_t{0}, n);
  in_team(threads, [&](int t) {
    const std::size_t share = t, team = threads;
    work(n * share / team, n * (share + 1) / team);
  });
}

/// Calls work(i) for every i < n, divided into the shares of the threads.
template <class Work>
void each_in_shares(int threads, std::size_t n, const Work& work) {
  in_shares(threads, n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

/// Returns Σ part(begin, end) over the shares, in their order.
template <class Part>
double sum_shares(int threads, std::size_t n, const Part& part) {
  std::vector<double> sums(threads, 0.0);
  const std::size_t team = threads;
  in_team(threads, [&](int t) {
    const std::size_t share = t;
    sums[share] = part(n * share / team, n * (share + 1) / team);
  });
  double sum = 0.0;
  for (const double s : sums) sum += s;
  return sum;
}

}  // namespace kacanov
