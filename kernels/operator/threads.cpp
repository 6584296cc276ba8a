// SPDX-License-Identifier: BSD-3-Clause
// Threads as a guest in somebody's process: whether they can be had, and what becomes of them after fork().
#include "operator/threads.hpp"

#include <omp.h>
#include <pthread.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace kacanov {
namespace {

std::atomic<bool> forked = false;

void watch_forks() {
  static const int registered = pthread_atfork(nullptr, nullptr, [] { forked = true; });
  if (registered != 0) throw std::system_error(registered, std::generic_category(), "pthread_atfork");
}

/// Starts and ends `count` threads that are there at the same time.
void require_threads(int count) {
  std::mutex mutex;
  std::condition_variable leave;
  bool all_there = false;
  std::vector<std::jthread> guests;
  const auto release = [&] {
    const std::lock_guard lock(mutex);
    all_there = true;
    leave.notify_all();
  };
  guests.reserve(count);
  try {
    for (int i = 0; i < count; ++i)
      guests.emplace_back([&] {
        std::unique_lock lock(mutex);
        leave.wait(lock, [&] { return all_there; });
      });
  } catch (const std::system_error& error) {
    release();
    throw std::system_error(error.code(), "threads: only " + std::to_string(guests.size() + 1) + " of " +
                                              std::to_string(count + 1) + " could be started");
  }
  release();
}

}  // namespace

void start_team(int threads) {
  if (threads <= 1 || is_forked_child()) return;
  watch_forks();
  require_threads(threads - 1);
#pragma omp parallel num_threads(threads)
  {}
}

bool is_forked_child() noexcept { return forked; }

void in_team(int threads, const std::function<void(int)>& run) {
  if (threads == 1 || is_forked_child()) {
    for (int t = 0; t < threads; ++t) run(t);
    return;
  }
  std::mutex mutex;
  std::exception_ptr thrown;
#pragma omp parallel num_threads(threads)
  {
    for (int t = omp_get_thread_num(); t < threads; t += omp_get_num_threads()) {
      try {
        run(t);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
      }
    }
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace kacanov
