// SPDX-License-Identifier: BSD-3-Clause
// MPI session of the program, and failures reported to all ranks.
#include "program/parallel.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <iostream>
#include <new>
#include <thread>

#include <kacanov/error.hpp>
#include "formats/printable.hpp"
#include "program/command.hpp"
#include "program/launch.hpp"

namespace kacanov {

MpiSession::MpiSession(std::function<void(const Failure&)> when_failing)
    : when_failing_(std::move(when_failing)) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  all_ = mpi_communicator(comm_);
  rank_ = all_.rank, ranks_ = all_.ranks;
}

MpiSession::MpiSession(MPI_Comm comm) : comm_(comm), hosted_(true), all_(mpi_communicator(comm)) {
  rank_ = all_.rank, ranks_ = all_.ranks;
}

MpiSession::~MpiSession() {
  if (hosted_) return;
  // mpiexec may end this process as soon as another one has exited.
  std::cout.flush();
  std::cerr.flush();
  MPI_Finalize();
}

void MpiSession::report(const Failure& failure) const {
  print_failure(failure);
  try {
    if (when_failing_) when_failing_(failure);
  } catch (...) {  // with a full disk or no memory nothing more can be done
  }
}

Failure current_failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return {exit_bad_input, "error: " + printable(error.what()), printable(error.what())};
  } catch (const std::bad_alloc&) {
    return {exit_failure, "internal failure: out of memory", "out of memory"};
  } catch (const std::exception& error) {
    return {exit_failure, std::string("internal failure: ") + error.what(), error.what()};
  }
}

void print_failure(const Failure& failure) {
  std::cerr << "kacanov: " + printable(failure.text) + "\n" << std::flush;
}

namespace {

/// Throws the failure of rank `speaker` on all ranks.
[[noreturn]] void throw_everywhere(const MpiSession& mpi, int speaker, int exit_code, std::string cause) {
  broadcast(mpi, cause, speaker);
  if (exit_code == exit_bad_input) throw InputError(cause);
  throw InternalError(cause);
}

}  // namespace

void together(const MpiSession& mpi, const std::function<void()>& work, CallSite at) {
  Failure failure;
  try {
    work();
  } catch (const std::bad_alloc&) {
    if (mpi.hosted() && mpi.ranks() == 1) throw;  // host interfaces have their own error code for it
    failure = current_failure();
  } catch (...) {
    failure = current_failure();
  }
  mpi.expect_all_here(at);
  int worst = 0;
  MPI_Allreduce(&failure.exit_code, &worst, 1, MPI_INT, MPI_MAX, mpi.comm());
  if (worst == 0) return;
  const int candidate = failure.exit_code == worst ? mpi.rank() : mpi.ranks();
  int speaker = 0;
  MPI_Allreduce(&candidate, &speaker, 1, MPI_INT, MPI_MIN, mpi.comm());
  if (mpi.hosted()) throw_everywhere(mpi, speaker, worst, failure.cause);
  if (speaker == mpi.rank()) mpi.report(failure);
  throw ReportedFailure{worst};
}

void broadcast(const MpiSession& mpi, std::string& text, int from, CallSite at) {
  mpi.expect_all_here(at);
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, from, mpi.comm());
  text.resize(size);
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_CHAR, from, mpi.comm());
}

void collectively(const MpiSession& mpi, const std::function<void()>& work) {
  try {
    work();
  } catch (const ReportedFailure&) {
    throw;
  } catch (...) {
    const Failure failure = current_failure();
    // If all ranks fail alike, the first one reports and aborts the job before the others wake up.
    if (!mpi.first()) std::this_thread::sleep_for(std::chrono::seconds(1));
    mpi.report(failure);
    if (mpi.ranks() > 1) MPI_Abort(mpi.comm(), coded_exit(failure.exit_code));
    throw ReportedFailure{failure.exit_code};
  }
}

}  // namespace kacanov
