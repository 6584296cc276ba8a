// SPDX-License-Identifier: BSD-3-Clause
// Allows one solve at a time in a host process.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace kacanov {

/// A timed mutex that can identify the thread that holds it, to detect a solve called from a callback.
class RunMutex {
 public:
  void lock() {
    mutex_.lock();
    holder_ = std::this_thread::get_id();
  }
  bool try_lock() { return held(mutex_.try_lock()); }
  bool try_lock_for(std::chrono::milliseconds most) { return held(mutex_.try_lock_for(most)); }
  void unlock() {
    holder_ = std::thread::id();
    mutex_.unlock();
  }
  bool is_mine() const noexcept { return holder_ == std::this_thread::get_id(); }

 private:
  bool held(bool locked) {
    if (locked) holder_ = std::this_thread::get_id();
    return locked;
  }

  std::timed_mutex mutex_;
  std::atomic<std::thread::id> holder_;
};

/// Held during a solve, because the libraries underneath support one run per process.
inline RunMutex one_run;

}  // namespace kacanov
