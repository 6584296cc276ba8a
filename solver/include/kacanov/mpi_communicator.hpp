// SPDX-License-Identifier: BSD-3-Clause
// Adapter from an MPI communicator to the Communicator of the kernels.
#pragma once

#include <mpi.h>

#include <kacanov/communicator.hpp>

namespace kacanov {

/// Returns the ranks of `comm` as a Communicator; `comm` must outlive it.
Communicator mpi_communicator(MPI_Comm comm);

/// Returns the MPI communicator it was created from, or MPI_COMM_SELF if it was created otherwise.
MPI_Comm mpi_of(const Communicator& communicator);

}  // namespace kacanov
