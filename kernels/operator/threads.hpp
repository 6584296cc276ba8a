// SPDX-License-Identifier: BSD-3-Clause
// Threads as a guest in somebody's process: whether they can be had, and what becomes of them after fork().
#pragma once

namespace kacanov {

/// Starts the calling thread's team of `threads` threads, which the passes then find waiting. Throws
/// std::system_error where the system does not grant so many: the OpenMP runtime, left to itself, would end
/// the process.
void start_team(int threads);

/// Whether this process is a child made by fork() after an operator: the threads of its parent's teams are
/// not there, and the runtime would wait for them for ever.
bool is_forked_child() noexcept;

}  // namespace kacanov
