// SPDX-License-Identifier: BSD-3-Clause
// Signals that ask a run to stop.
#pragma once

#include <csignal>

namespace kacanov {

/// What the starting process sends through mpiexec, which passes it on to every rank, instead of the signals
/// that would make mpiexec kill them.
constexpr int stop_signal = SIGUSR1;

/// From now on a thread watches for SIGINT, SIGTERM, SIGHUP (unless they are ignored) and stop_signal, and
/// ends the process by the first one.
void take_signals();

/// From now on they only ask for a stop. One more than a second later, stop_signal apart, ends the process
/// all the same; and so does the first one where nobody has called stop_came_in_time() within `patience`
/// seconds: a rank that hangs keeps all others from stopping, and their end is that of the whole run.
void listen_for_interrupts(double patience);

/// What may take long is over: from now on there is output to write, and only a second signal ends that.
void stop_came_in_time() noexcept;

/// Whether one has come.
bool interrupt_came() noexcept;

}  // namespace kacanov
