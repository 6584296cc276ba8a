// SPDX-License-Identifier: BSD-3-Clause
// MPI within a process that others have started and that goes on after a solve.
#pragma once

namespace kacanov {

/// Starts MPI in this process alone unless somebody has already. Environment and signal handlers are as
/// before afterwards. True where this call has started it: then end_host_mpi() is due at the process's end.
/// One call at a time. Throws InternalError where MPI has been ended, or was started in a parent process.
bool start_host_mpi();

/// Ends MPI if start_host_mpi() has started it in this very process and nobody has ended it since.
void end_host_mpi();

}  // namespace kacanov
