// SPDX-License-Identifier: BSD-3-Clause
// The ranks of an MPI communicator as the library knows them.
#pragma once

#include <mpi.h>

#include <kacanov/communicator.hpp>

namespace kacanov {

/// All ranks of `comm`, which has to outlive what is made.
Communicator mpi_communicator(MPI_Comm comm);

/// The communicator it was made of; MPI_COMM_SELF where it was not.
MPI_Comm mpi_of(const Communicator& communicator);

}  // namespace kacanov
