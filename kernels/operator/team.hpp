// SPDX-License-Identifier: BSD-3-Clause
// A thread and its helpers, which wait for work for some microseconds awake and then asleep.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace kacanov {

/// How long a thread waits awake before it sleeps. Other programs want the cores, too, and the one waited for
/// may need this very core: who has waited for long is less patient the next time.
class Patience {
 public:
  /// Of one in a team of `threads`; none where these are more than the cores.
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
  /// One less. Only zero wakes those who sleep.
  void count_down() noexcept;

  /// Waits until there(value), and returns that value.
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

/// The thread that makes it, and helpers. Every share of a job is done once, by whoever comes first: helpers
/// that the system lets wait are not waited for, unless they are in the middle of a share.
class Team {
 public:
  using Call = void (*)(void* job, int share);

  /// With as many of `shares` − 1 helpers as the system grants. They take no signals.
  explicit Team(int shares);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const noexcept { return static_cast<int>(helpers_.size()) + 1; }
  int most_shares() const noexcept { return static_cast<int>(shares_.size()); }
  /// call(job, t), which must not throw, for every t < shares ≤ most_shares(). By the thread that has made
  /// the team, and not from within a share.
  void run(int shares, Call call, void* job) noexcept;

 private:
  /// The last round in which it was taken; padded, so that taking one costs the others nothing.
  struct alignas(64) Share {
    std::atomic<unsigned> round = 0;
  };
  void do_shares(int first, unsigned round) noexcept;
  void help(int number) noexcept;

  Patience patience_;  ///< of the thread that has made it
  std::vector<Share> shares_;
  Call call_ = nullptr;
  void* job_ = nullptr;
  alignas(64) Awaited round_;
  alignas(64) Awaited left_;  ///< shares of this round that are not done
  std::atomic<bool> over_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace kacanov
