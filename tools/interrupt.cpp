// SPDX-License-Identifier: BSD-3-Clause
// Signals that ask a run to stop.
#include "interrupt.hpp"

#include <ctime>
#include <initializer_list>

namespace kacanov {
namespace {

volatile std::sig_atomic_t came = 0;
timespec first_time{};

extern "C" void note(int signal) {
  came = 1;
  if (signal == stop_signal || !asks_again(first_time)) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

bool asks_again(timespec& first) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (first.tv_sec == 0 && first.tv_nsec == 0) {
    first = now;
    return false;
  }
  return static_cast<double>(now.tv_sec - first.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - first.tv_nsec) > 1.0;
}

void listen_for_interrupts() {
  struct sigaction action {
  }, before{};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, stop_signal}) {
    if (sigaction(signal, nullptr, &before) == 0 && (before.sa_handler != SIG_IGN || signal == stop_signal))
      sigaction(signal, &action, nullptr);
  }
}

bool interrupt_came() noexcept { return came != 0; }

}  // namespace kacanov
