// SPDX-License-Identifier: BSD-3-Clause
// Thread teams of a library inside a host process: own threads or OpenMP's, availability, and fork().
#include "operator/threads.hpp"

#include <omp.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "operator/team.hpp"

namespace kacanov {
namespace {

/// Source of the threads, as chosen when the last operator was created.
enum class Workers { not_asked, own, openmp };
std::atomic<Workers> chosen_workers = Workers::not_asked;

Workers choose_workers() {
  const char* variable = std::getenv("KACANOV_THREADS");
  const std::string_view wanted = variable != nullptr ? variable : "";
  if (!wanted.empty() && wanted != "own" && wanted != "openmp")
    throw std::invalid_argument("KACANOV_THREADS: expected own or openmp, got \"" + std::string(wanted) +
                                "\"");
  return chosen_workers = wanted == "openmp" ? Workers::openmp : Workers::own;
}

Workers workers() {
  const Workers chosen = chosen_workers;
  return chosen == Workers::not_asked ? choose_workers() : chosen;
}

std::atomic<bool> forked = false;
thread_local bool within_share = false;  ///< true while executing a share, whose work is not divided again
thread_local bool thread_ends = false;

void watch_forks() {
  static const int registered = pthread_atfork(nullptr, nullptr, [] { forked = true; });
  if (registered != 0) throw std::system_error(registered, std::generic_category(), "pthread_atfork");
}

/// The team of a host thread, which ends with it.
struct OwnTeam {
  std::unique_ptr<Team> team;

  ~OwnTeam() {
    thread_ends = true;
    if (is_forked_child()) static_cast<void>(team.release());  // its helpers belong to the parent
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

[[noreturn]] void throw_too_few(int there, int threads) {
  throw std::system_error(
      std::make_error_code(std::errc::resource_unavailable_try_again),
      "threads: only " + std::to_string(there) + " of " + std::to_string(threads) + " could be started");
}

/// Number of threads, the caller's included, that the system grants at the same time, up to `threads`: starts
/// them and lets them end.
int granted_threads(int threads) {
  std::mutex mutex;
  std::condition_variable leave;
  bool all_there = false;
  std::vector<std::jthread> guests;
  guests.reserve(static_cast<std::size_t>(threads - 1));
  try {
    while (static_cast<int>(guests.size()) < threads - 1)
      guests.emplace_back([&] {
        std::unique_lock lock(mutex);
        leave.wait(lock, [&] { return all_there; });
      });
  } catch (const std::system_error&) {  // those that were started are the result
  }
  {
    const std::lock_guard lock(mutex);
    all_there = true;
  }
  leave.notify_all();
  return static_cast<int>(guests.size()) + 1;
}

/// Number of OpenMP threads that a host thread has requested, and the number available. OpenMP's runtime
/// would terminate the process if it could not get its threads.
struct OpenMPTeam {
  int asked = 1, there = 1;

  int of(int threads) {
    if (asked < threads) ask(threads);
    return std::min(threads, there);
  }
  void ask(int threads) {
    there = std::max(there, granted_threads(threads));  // the runtime keeps its threads
    asked = threads;
  }
};
thread_local OpenMPTeam openmp_team;

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

/// Thread t executes share t, if the runtime grants that many threads.
void do_shares_with_openmp(int shares, int threads, Job& job) {
#pragma omp parallel num_threads(threads)
  for (int t = omp_get_thread_num(); t < shares; t += omp_get_num_threads()) job.do_share(t);
}

}  // namespace

void start_team(int threads) {
  const Workers who = choose_workers();
  if (is_alone(threads)) return;
  watch_forks();
  if (who == Workers::openmp) {
    if (openmp_team.of(threads) < threads) openmp_team.ask(threads);  // the system may grant more now
    if (openmp_team.there < threads) throw_too_few(openmp_team.there, threads);
    return in_team(threads, [](int) {});
  }
  OwnTeam& own = own_team();
  if (own.of(threads).threads() < threads) own.make(threads);  // the system may grant more now
  if (own.team->threads() < threads) throw_too_few(own.team->threads(), threads);
}

bool is_forked_child() noexcept { return forked; }

void in_team(int threads, const std::function<void(int)>& run) {
  if (is_alone(threads)) {
    for (int t = 0; t < threads; ++t) run(t);
    return;
  }
  Job job{run};
  if (workers() == Workers::openmp)
    do_shares_with_openmp(threads, openmp_team.of(threads), job);
  else
    own_team().of(threads).run(
        threads, [](void* opaque, int t) { static_cast<Job*>(opaque)->do_share(t); }, &job);
  if (job.thrown) std::rethrow_exception(job.thrown);
}

}  // namespace kacanov
