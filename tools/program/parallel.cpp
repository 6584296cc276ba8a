// SPDX-License-Identifier: BSD-3-Clause
// MPI from start to end of the program, and failures that all ranks learn of.
#include "program/parallel.hpp"

#include <chrono>
#include <exception>
#include <iostream>
#include <new>
#include <thread>

#include <kacanov/error.hpp>
#include "formats/printable.hpp"
#include "program/command.hpp"
#include "program/launch.hpp"

namespace kacanov {

MpiSession::MpiSession() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

MpiSession::~MpiSession() {
  // mpiexec may end this process as soon as another one has left.
  std::cout.flush();
  std::cerr.flush();
  MPI_Finalize();
}

void MpiSession::report(const Failure& failure) const {
  print_failure(failure);
  try {
    if (when_failing_) when_failing_(failure.text);
  } catch (...) {  // with a full disk, or no memory, there is no more to be done
  }
}

Failure current_failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return {exit_bad_input, std::string("error: ") + error.what()};
  } catch (const std::bad_alloc&) {
    return {exit_failure, "internal failure: out of memory"};
  } catch (const std::exception& error) {
    return {exit_failure, std::string("internal failure: ") + error.what()};
  }
}

void print_failure(const Failure& failure) {
  std::cerr << "kacanov: " + printable(failure.text) + "\n" << std::flush;
}

void together(const MpiSession& mpi, const std::function<void()>& work) {
  Failure failure;
  try {
    work();
  } catch (...) {
    failure = current_failure();
  }
  int worst = 0;
  MPI_Allreduce(&failure.exit_code, &worst, 1, MPI_INT, MPI_MAX, mpi.comm());
  if (worst == 0) return;
  const int candidate = failure.exit_code == worst ? mpi.rank() : mpi.ranks();
  int speaker = 0;
  MPI_Allreduce(&candidate, &speaker, 1, MPI_INT, MPI_MIN, mpi.comm());
  if (speaker == mpi.rank()) mpi.report(failure);
  throw ReportedFailure{worst};
}

void collectively(const MpiSession& mpi, const std::function<void()>& work) {
  try {
    work();
  } catch (const ReportedFailure&) {
    throw;
  } catch (...) {
    const Failure failure = current_failure();
    // Where all ranks fail alike, the first one speaks and ends the job before the others wake up.
    if (!mpi.first()) std::this_thread::sleep_for(std::chrono::seconds(1));
    mpi.report(failure);
    if (mpi.ranks() > 1) MPI_Abort(mpi.comm(), coded_exit(failure.exit_code));
    throw ReportedFailure{failure.exit_code};
  }
}

}  // namespace kacanov
