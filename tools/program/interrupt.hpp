// SPDX-License-Identifier: BSD-3-Clause
// Signals that stop a run.
#pragma once

#include <csignal>

namespace kacanov {

/// Signal that the starting process sends through mpiexec to every rank, because the usual ones would make
/// mpiexec kill the ranks.
constexpr int stop_signal = SIGUSR1;

/// Starts a thread that watches for SIGINT, SIGTERM, SIGHUP (unless ignored) and stop_signal, and ends the
/// process at the first one.
void take_signals();

/// From now on the first signal only requests a stop. Another one more than a second later (except
/// stop_signal) ends the process, as does the first if stop_came_in_time() is not called within `patience`
/// seconds: a rank that hangs keeps the others from stopping, and its end stops the whole run.
void listen_for_interrupts(double patience);

/// Marks the end of the computation: what remains is output, which only a second signal ends.
void stop_came_in_time() noexcept;

/// Returns whether a signal has arrived.
bool interrupt_came() noexcept;

}  // namespace kacanov
