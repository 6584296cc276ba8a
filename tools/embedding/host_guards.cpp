// SPDX-License-Identifier: BSD-3-Clause
// Guards for a solve inside a host process: one run at a time, and the life of MPI.
#include "embedding/host_guards.hpp"

#include <mpi.h>

#include <cstdlib>

#include <kacanov/error.hpp>
#include "c/laws.hpp"
#include "program/host_mpi.hpp"

namespace kacanov::embedding {
namespace {

/// Runs at process exit. Leaves MPI alone while another thread is in a run.
void end_mpi() {
  const std::unique_lock alone(one_run, std::try_to_lock);
  if (alone) end_host_mpi();
}

}  // namespace

std::unique_lock<RunMutex> begin_run() {
  if (one_run.is_mine())
    throw c_api::Fault(KACANOV_ERROR_STATE, "kacanov_solve: called from a callback of a solve");
  return std::unique_lock(one_run);
}

void require_mpi() {
  try {
    if (start_host_mpi()) std::atexit(&end_mpi);
  } catch (const InternalError& error) {
    throw c_api::Fault(KACANOV_ERROR_STATE, error.what());
  }
  int level = MPI_THREAD_SINGLE, is_main = 0;
  MPI_Query_thread(&level);
  MPI_Is_thread_main(&is_main);
  if (level < MPI_THREAD_SERIALIZED && is_main == 0)
    throw c_api::Fault(KACANOV_ERROR_STATE,
                       "the host has started MPI without MPI_THREAD_SERIALIZED: solve on its main thread");
}

}  // namespace kacanov::embedding
