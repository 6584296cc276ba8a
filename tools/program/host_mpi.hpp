// SPDX-License-Identifier: BSD-3-Clause
// MPI inside a host process, which continues after a solve.
#pragma once

namespace kacanov {

/// Starts MPI for this process alone unless it is already initialised, and restores environment variables and
/// signal handlers. Returns true if this call started it: call end_host_mpi() at process exit. Not
/// thread-safe. Throws InternalError if MPI was finalised, or was started in a parent process.
bool start_host_mpi();

/// Finalises MPI if start_host_mpi() started it in this process and it is not finalised yet.
void end_host_mpi();

}  // namespace kacanov
