// SPDX-License-Identifier: BSD-3-Clause
// Signals of this process as bytes in a pipe (self-pipe).
#pragma once

#include <csignal>
#include <initializer_list>

namespace kacanov {

/// From now on these signals arrive in signal_pipe(), whichever thread the system hands them to: a handler
/// writes them there. Signals that are ignored, as under nohup, stay ignored, but for those of `always`.
/// Throws InternalError where no pipe can be made.
void catch_signals(std::initializer_list<int> signals, std::initializer_list<int> always = {});

/// The reading end; -1 before catch_signals().
int signal_pipe() noexcept;

/// Waits for the next signal; 0 where none comes within `milliseconds` (-1: without a limit).
int next_signal(int milliseconds) noexcept;

/// Whether catch_signals() has set the handler of this signal.
bool is_caught(int signal) noexcept;

/// Ends the process by this signal, as if it had never been caught.
[[noreturn]] void end_by(int signal) noexcept;

/// Whether this signal comes as a second request. `timeout` and terminals may send one request twice within
/// moments.
bool asks_again(timespec& first) noexcept;

double seconds_since(const timespec& then) noexcept;

}  // namespace kacanov
