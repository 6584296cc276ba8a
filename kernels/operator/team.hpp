// SPDX-License-Identifier: BSD-3-Clause
// A team of helper threads that spin for some microseconds while they wait for work, and then sleep.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace kacanov {

/// How long a waiting thread spins before it sleeps. Spinning takes cores from other programs and perhaps
/// from the awaited thread itself; therefore after a long wait the next spin is shorter.
class Patience {
 public:
  /// For a thread in a team of `threads`; no spinning if there are more threads than cores.
  explicit Patience(int threads);

  std::chrono::nanoseconds now() const noexcept { return now_; }
  void has_waited(std::chrono::nanoseconds time) noexcept;

 private:
  std::chrono::nanoseconds most_, now_;
};

/// A number that threads wait for.
class Awaited {
 public:
  unsigned value() const noexcept { return value_.load(std::memory_order_acquire); }
  void set(unsigned value) noexcept;
  /// Decrements the number. Wakes sleeping threads only at zero.
  void count_down() noexcept;

  /// Waits until there(value) is true, and returns that value.
  template <class There>
  unsigned wait(Patience& patience, const There& there);

 private:
  void wake() noexcept;
  template <class There>
  unsigned sleep(const There& there);

  std::atomic<unsigned> value_ = 0;
  std::atomic<int> sleepers_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
};

/// The calling thread and helpers. Each share of a job is executed once, by the first thread that takes it;
/// run() does not wait for helpers that the system has not scheduled, unless they are executing a share.
class Team {
 public:
  using Call = void (*)(void* job, int share);

  /// Starts `shares` − 1 helpers, or as many as the system grants. Helpers block signals.
  explicit Team(int shares);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const noexcept { return static_cast<int>(helpers_.size()) + 1; }
  int most_shares() const noexcept { return static_cast<int>(shares_.size()); }
  /// Executes call(job, t), which must not throw, for every t < shares ≤ most_shares(). Only on the thread
  /// that created the team, and not from within a share.
  void run(int shares, Call call, void* job) noexcept;

 private:
  /// The last round in which the share was taken; padded against false sharing.
  struct alignas(64) Share {
    std::atomic<unsigned> round = 0;
  };
  void do_shares(int first, unsigned round) noexcept;
  void help(int number) noexcept;

  Patience patience_;  ///< of the thread that created the team
  std::vector<Share> shares_;
  Call call_ = nullptr;
  void* job_ = nullptr;
  alignas(64) Awaited round_;
  alignas(64) Awaited left_;  ///< unfinished shares of this round
  std::atomic<bool> over_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace kacanov
