// SPDX-License-Identifier: BSD-3-Clause
// Signals that stop a run.
#include "program/interrupt.hpp"

#include <atomic>
#include <ctime>
#include <thread>

#include "program/signal_pipe.hpp"

namespace kacanov {
namespace {

std::atomic<bool> listening = false, came = false, in_time = false;
std::atomic<double> seconds_to_stop = 0.0;

void catch_stop_signals() { catch_signals({SIGINT, SIGTERM, SIGHUP}, {stop_signal}); }

void watch_for_signals() {
  constexpr int a_while = 200;  // milliseconds between checks of the clock
  timespec first{}, asked{};
  for (int last = 0;;) {
    const int signal = next_signal(last == 0 ? -1 : a_while);
    if (signal != 0 && (!listening || (signal != stop_signal && asks_again(first)))) end_by(signal);
    if (signal != 0 && last == 0) {
      last = signal;
      clock_gettime(CLOCK_MONOTONIC, &asked);
      came = true;
    }
    if (!in_time && seconds_since(asked) > seconds_to_stop) end_by(last);
  }
}

}  // namespace

void take_signals() {
  catch_stop_signals();
  std::thread([] {
    catch_stop_signals();  // unblocks the signals in this thread at least
    watch_for_signals();
  }).detach();
}

void listen_for_interrupts(double patience) {
  catch_stop_signals();  // MPI may have replaced the handlers
  seconds_to_stop = patience;
  listening = true;
}

void stop_came_in_time() noexcept { in_time = true; }

bool interrupt_came() noexcept { return came; }

}  // namespace kacanov
