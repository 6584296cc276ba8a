// SPDX-License-Identifier: BSD-3-Clause
// Signals that ask a run to stop.
#include "program/interrupt.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <thread>

namespace kacanov {
namespace {

std::atomic<bool> listening = false, came = false, in_time = false;
std::atomic<double> seconds_to_stop = 0.0;
std::atomic<bool> held = false;
pthread_t worker{};  // the thread that asked for this one

extern "C" void hold(int) {
  held = true;
  while (true) pause();
}

/// Holds the worker where it is, or goes on after a second where it cannot be reached. METIS sets and resets
/// handlers of SIGTERM as it works; one set between the two lines of die_of() would be run by a thread that
/// it does not know.
void hold_worker() {
  constexpr timespec moment{0, 1'000'000};
  std::signal(SIGUSR2, hold);
  pthread_kill(worker, SIGUSR2);
  for (int tries = 0; !held && tries < 1000; ++tries) nanosleep(&moment, nullptr);
}

/// As if nobody had ever taken the signal.
void die_of(int signal) {
  hold_worker();
  std::signal(signal, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  std::raise(signal);
}

double seconds_since(const timespec& then) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec - then.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec - then.tv_nsec);
}

/// The next signal of the set; 0 where none comes for a while.
int next_signal(const sigset_t& set) {
  constexpr timespec a_while{0, 200'000'000};
  return std::max(sigtimedwait(&set, nullptr, &a_while), 0);
}

void wait_for_signals(const sigset_t& set) {
  timespec first{}, asked{};
  for (int last = 0;;) {
    int signal = 0;
    if (last == 0)
      sigwait(&set, &signal);
    else
      signal = next_signal(set);
    if (signal != 0 && (!listening || (signal != stop_signal && asks_again(first)))) die_of(signal);
    if (signal != 0 && last == 0) {
      last = signal;
      clock_gettime(CLOCK_MONOTONIC, &asked);
      came = true;
    }
    if (!in_time && seconds_since(asked) > seconds_to_stop) die_of(last);
  }
}

}  // namespace

bool asks_again(timespec& first) noexcept {
  if (first.tv_sec != 0 || first.tv_nsec != 0) return seconds_since(first) > 1.0;
  clock_gettime(CLOCK_MONOTONIC, &first);
  return false;
}

void take_signals() {
  sigset_t set;
  sigemptyset(&set);
  struct sigaction before {};
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, stop_signal}) {
    // What was to be ignored, as under nohup, still is.
    if (sigaction(signal, nullptr, &before) == 0 && (before.sa_handler != SIG_IGN || signal == stop_signal))
      sigaddset(&set, signal);
  }
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  worker = pthread_self();
  std::thread(wait_for_signals, set).detach();
}

void listen_for_interrupts(double patience) {
  seconds_to_stop = patience;
  listening = true;
}

void stop_came_in_time() noexcept { in_time = true; }

bool interrupt_came() noexcept { return came; }

}  // namespace kacanov
