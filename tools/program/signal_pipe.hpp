// SPDX-License-Identifier: BSD-3-Clause
// Delivers signals of this process as bytes in a pipe (self-pipe).
#pragma once

#include <csignal>
#include <initializer_list>

namespace kacanov {

/// Installs a handler that writes these signals to signal_pipe(), whichever thread receives them. Ignored
/// signals, as under nohup, stay ignored, except those in `always`. Throws InternalError if no pipe can be
/// created.
void catch_signals(std::initializer_list<int> signals, std::initializer_list<int> always = {});

/// The reading end; -1 before catch_signals().
int signal_pipe() noexcept;

/// Waits for the next signal; returns 0 if none arrives within `milliseconds` (-1: no limit).
int next_signal(int milliseconds) noexcept;

/// Returns whether catch_signals() has set the handler of this signal.
bool is_caught(int signal) noexcept;

/// Ends the process by this signal, as if it had never been caught.
[[noreturn]] void end_by(int signal) noexcept;

/// Returns whether this signal is a second request. `timeout` and terminals may send one request twice within
/// moments.
bool asks_again(timespec& first) noexcept;

double seconds_since(const timespec& then) noexcept;

}  // namespace kacanov
