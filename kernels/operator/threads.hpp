// SPDX-License-Identifier: BSD-3-Clause
// Threads as a guest in somebody's process: whose they are, whether they can be had, and what becomes of them
// after fork().
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace kacanov {

/// Starts the calling thread's team of `threads` threads, which the passes then find waiting: the library's
/// own, or, where the environment variable KACANOV_THREADS says "openmp", OpenMP's, from now on in all of the
/// process. Throws std::invalid_argument for other values than that and "own", std::system_error where the
/// system does not grant so many threads.
void start_team(int threads);

/// Whether this process is a child made by fork() after an operator: the threads of its parent's teams are
/// not there.
bool is_forked_child() noexcept;

/// Calls run(t) once for every t < threads, on the calling thread and its team: one after another where there
/// is none, as within such a call. Which thread calls which does not matter to the results. What one of them
/// throws is thrown once all are done.
void in_team(int threads, const std::function<void(int)>& run);

/// Calls work(begin, end) for the shares of the threads in 0 … n − 1; at once where these are not worth
/// waking anybody.
template <class Work>
void in_shares(int threads, std::size_t n, const Work& work) {
  constexpr std::size_t worth = 2048;
  if (threads == 1 || n < worth) return work(std::size_t{0}, n);
  in_team(threads, [&](int t) {
    const std::size_t share = t, team = threads;
    work(n * share / team, n * (share + 1) / team);
  });
}

/// Calls work(i) for every i < n, in the shares of the threads.
template <class Work>
void each_in_shares(int threads, std::size_t n, const Work& work) {
  in_shares(threads, n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

/// Σ part(begin, end) over the shares, in their order.
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
