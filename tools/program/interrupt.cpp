// SPDX-License-Identifier: BSD-3-Clause
// Signals that ask a run to stop.
#include "program/interrupt.hpp"

#include <atomic>
#include <ctime>
#include <thread>

namespace kacanov {
namespace {

std::atomic<bool> listening = false, came = false;

/// As if nobody had ever taken the signal.
void die_of(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  std::raise(signal);
}

void wait_for_signals(const sigset_t& set) {
  timespec first{};
  for (int signal = 0; sigwait(&set, &signal) == 0;) {
    if (!listening || (signal != stop_signal && asks_again(first))) die_of(signal);
    came = true;
  }
}

}  // namespace

bool asks_again(timespec& first) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (first.tv_sec == 0 && first.tv_nsec == 0) {
    first = now;
    return false;
  }
  return static_cast<double>(now.tv_sec - first.tv_sec) +
             1e-9 * static_cast<double>(now.tv_nsec - first.tv_nsec) >
         1.0;
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
  std::thread(wait_for_signals, set).detach();
}

void listen_for_interrupts() { listening = true; }

bool interrupt_came() noexcept { return came; }

}  // namespace kacanov
