// SPDX-License-Identifier: BSD-3-Clause
// What a solve takes care of in a process that is not its own: one run at a time, MPI.
#pragma once

#include <mutex>

#include "program/one_run.hpp"

namespace kacanov::embedding {

/// Waits until nobody else is at a run. Throws Fault where this thread is at one.
std::unique_lock<RunMutex> begin_run();

/// Starts MPI unless it is there. Throws Fault where it has been ended, or not for this thread.
void require_mpi();

}  // namespace kacanov::embedding
