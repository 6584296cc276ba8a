// SPDX-License-Identifier: BSD-3-Clause
// A team of helper threads that spin for some microseconds while they wait for work, and then sleep.
#include "operator/team.hpp"

#include <pthread.h>

#include <algorithm>
#include <csignal>

namespace kacanov {
namespace {

using Clock = std::chrono::steady_clock;

// Maximum: a few times the wake-up time of a thread; minimum: the remainder where spinning does not help. On
// two free cores a multigrid of 56,355 unknowns takes 0.09 s with 100 us, 0.10 s with 20, 0.14 s with none.
constexpr std::chrono::nanoseconds most_patience = std::chrono::microseconds(100);
constexpr std::chrono::nanoseconds least_patience = std::chrono::microseconds(5);

void pause_for_a_moment() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Helpers block signals, which the host's threads should get, except those of the thread's own faults and
/// SIGPROF.
class NoSignals {
 public:
  NoSignals() {
    sigset_t all;
    sigfillset(&all);
    for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS, SIGPROF})
      sigdelset(&all, own);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~NoSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  NoSignals(const NoSignals&) = delete;
  NoSignals& operator=(const NoSignals&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

Patience::Patience(int threads) : most_(most_patience), now_(most_patience) {
  const unsigned cores = std::thread::hardware_concurrency();
  if (cores != 0 && static_cast<unsigned>(threads) > cores) most_ = now_ = {};
}

void Patience::has_waited(std::chrono::nanoseconds time) noexcept {
  now_ = time <= most_ ? most_ : std::min(most_, std::max(now_ / 2, least_patience));
}

// All accesses that may wake or sleep are sequentially consistent: either the thread that sets the number
// sees the sleeper, or the sleeper sees the number.

void Awaited::wake() noexcept {
  if (sleepers_.load() == 0) return;
  { const std::lock_guard not_between_looking_and_sleeping(mutex_); }
  changed_.notify_all();
}

void Awaited::set(unsigned value) noexcept {
  value_.store(value);
  wake();
}

void Awaited::count_down() noexcept {
  if (value_.fetch_sub(1) == 1) wake();
}

template <class There>
unsigned Awaited::sleep(const There& there) {
  std::unique_lock lock(mutex_);
  ++sleepers_;
  unsigned now = 0;
  changed_.wait(lock, [&] { return there(now = value_.load()); });
  --sleepers_;
  return now;
}

template <class There>
unsigned Awaited::wait(Patience& patience, const There& there) {
  const Clock::time_point begin = Clock::now();
  do {
    for (int i = 0; i < 16; ++i) {
      const unsigned now = value();
      if (there(now)) return now;
      pause_for_a_moment();
    }
  } while (Clock::now() - begin < patience.now());
  const unsigned now = sleep(there);
  patience.has_waited(Clock::now() - begin);
  return now;
}

Team::Team(int shares) : patience_(shares), shares_(static_cast<std::size_t>(shares)) {
  helpers_.reserve(shares_.size());
  const NoSignals while_they_start;
  try {
    for (int number = 1; number < shares; ++number) helpers_.emplace_back([this, number] { help(number); });
  } catch (...) {  // the other threads do their shares
  }
}

Team::~Team() {
  over_ = true;
  round_.set(round_.value() + 1);
  for (std::thread& helper : helpers_) helper.join();
}

void Team::run(int shares, Call call, void* job) noexcept {
  const unsigned round = round_.value() + 1;
  call_ = call;
  job_ = job;
  left_.set(static_cast<unsigned>(shares));
  for (std::size_t t = static_cast<std::size_t>(shares); t < shares_.size(); ++t) shares_[t].round = round;
  round_.set(round);
  do_shares(0, round);
  left_.wait(patience_, [](unsigned left) { return left == 0; });
}

/// Takes shares of the round that no thread has started, beginning with one that is no other thread's first.
/// A late thread takes nothing: in a finished round every share is marked with this round.
void Team::do_shares(int first, unsigned round) noexcept {
  const int count = most_shares();
  for (int i = 0; i < count; ++i) {
    const int t = (first + i) % count;
    std::atomic<unsigned>& taken = shares_[static_cast<std::size_t>(t)].round;
    unsigned before = round - 1;
    if (taken != before || !taken.compare_exchange_strong(before, round)) continue;
    call_(job_, t);
    left_.count_down();
  }
}

void Team::help(int number) noexcept {
  Patience patience(most_shares());
  unsigned round = 0;
  for (;;) {
    round = round_.wait(patience, [round](unsigned now) { return now != round; });
    if (over_) return;
    do_shares(number, round);
  }
}

}  // namespace kacanov
