// SPDX-License-Identifier: BSD-3-Clause
// MPI within a process that others have started: Python's.
#pragma once

#include <mpi.h>

namespace kacanov::python {

/// Starts MPI in this process alone unless somebody (mpi4py) has already, and ends it with Python then. The
/// environment is as before afterwards. With Python's lock. Throws InternalError where MPI has been ended.
void ensure_mpi();

}  // namespace kacanov::python
