// SPDX-License-Identifier: BSD-3-Clause
// Guards for a solve inside a host process: one run at a time, and the life of MPI.
#pragma once

#include <mutex>

#include "program/one_run.hpp"

namespace kacanov::embedding {

/// Waits until no other thread is in a run. Throws Fault if this thread is already in one.
std::unique_lock<RunMutex> begin_run();

/// Starts MPI unless it is initialised. Throws Fault if MPI was finalised or may not be used by this thread.
void require_mpi();

}  // namespace kacanov::embedding
