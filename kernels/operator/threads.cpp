// SPDX-License-Identifier: BSD-3-Clause
// Threads as a guest in somebody's process: whether they can be had, and what becomes of them after fork().
#include "operator/threads.hpp"

#include <pthread.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>

#include "operator/team.hpp"

namespace kacanov {
namespace {

std::atomic<bool> forked = false;
thread_local bool within_share = false;  ///< whose own work is not divided further
thread_local bool thread_ends = false;

void watch_forks() {
  static const int registered = pthread_atfork(nullptr, nullptr, [] { forked = true; });
  if (registered != 0) throw std::system_error(registered, std::generic_category(), "pthread_atfork");
}

/// The team of a thread of the host's, which ends with it.
struct OwnTeam {
  std::unique_ptr<Team> team;

  ~OwnTeam() {
    thread_ends = true;
    if (is_forked_child()) static_cast<void>(team.release());  // its helpers are the parent's
  }
  Team& of(int shares) {
    if (!team || team->most_shares() < shares) make(shares);
    return *team;
  }
  void make(int shares) {
    team.reset();
    team = std::make_unique<Team>(shares);
  }
};

OwnTeam& own_team() {
  thread_local OwnTeam own;
  return own;
}

bool is_alone(int threads) { return threads <= 1 || within_share || thread_ends || is_forked_child(); }

struct Job {
  const std::function<void(int)>& run;
  std::mutex mutex = {};
  std::exception_ptr thrown = {};

  void do_share(int t) noexcept {
    within_share = true;
    try {
      run(t);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
    within_share = false;
  }
};

}  // namespace

void start_team(int threads) {
  if (is_alone(threads)) return;
  watch_forks();
  OwnTeam& own = own_team();
  if (own.of(threads).threads() < threads) own.make(threads);  // the system may grant more by now
  const int there = own.team->threads();
  if (there < threads)
    throw std::system_error(
        std::make_error_code(std::errc::resource_unavailable_try_again),
        "threads: only " + std::to_string(there) + " of " + std::to_string(threads) + " could be started");
}

bool is_forked_child() noexcept { return forked; }

void in_team(int threads, const std::function<void(int)>& run) {
  if (is_alone(threads)) {
    for (int t = 0; t < threads; ++t) run(t);
    return;
  }
  Job job{run};
  own_team().of(threads).run(
      threads, [](void* opaque, int t) { static_cast<Job*>(opaque)->do_share(t); }, &job);
  if (job.thrown) std::rethrow_exception(job.thrown);
}

}  // namespace kacanov
