// SPDX-License-Identifier: BSD-3-Clause
// One solve at a time in a process that others have started.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace kacanov {

/// A mutex of std's that can tell the thread that holds it: there a callback asks for another run.
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

/// The libraries beneath know one run a process: who solves holds this meanwhile.
inline RunMutex one_run;

}  // namespace kacanov
