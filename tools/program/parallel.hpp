// SPDX-License-Identifier: BSD-3-Clause
// MPI session of the program, and failures reported to all ranks.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>
#include <utility>

#include <kacanov/part.hpp>

namespace kacanov {

/// Exit code and text of the current exception: 2 for InputError, else 3.
struct Failure {
  int exit_code = 0;
  std::string text;
  std::string cause = {};  ///< the text without a prefix such as "error: "
};
Failure current_failure();

/// Prints "kacanov: error: ..." to standard error.
void print_failure(const Failure& failure);

/// An MPI session from MPI_Init to MPI_Finalize; or, inside a host process, a communicator of the host.
class MpiSession {
 public:
  /// `when_failing`: see below.
  explicit MpiSession(std::function<void(const Failure&)> when_failing = {});
  /// Session inside a host process: functions that take it print nothing, and together() throws the error of
  /// one rank on every rank.
  explicit MpiSession(MPI_Comm comm);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  MPI_Comm comm() const noexcept { return comm_; }
  bool hosted() const noexcept { return hosted_; }
  int rank() const noexcept { return rank_; }
  int ranks() const noexcept { return ranks_; }
  bool first() const noexcept { return rank_ == 0; }
  /// Call it before direct MPI calls (Communicator::expect_all_here).
  void expect_all_here(CallSite at = CallSite()) const { all_.expect_all_here(at); }

  /// Sets an extra action after a failure, on the rank that prints it. It must not communicate; its
  /// exceptions are ignored.
  void when_failing(std::function<void(const Failure&)> work) { when_failing_ = std::move(work); }
  /// Prints a failure and runs the extra action.
  void report(const Failure& failure) const;

 private:
  MPI_Comm comm_ = MPI_COMM_WORLD;
  bool hosted_ = false;
  int rank_ = 0, ranks_ = 1;
  Communicator all_;
  std::function<void(const Failure&)> when_failing_;
};

/// Thrown on all ranks once the cause has been printed.
struct ReportedFailure {
  int exit_code;
};

/// Runs `work`, which must not communicate, on every rank. If it throws on any rank, one message is printed
/// and every rank throws ReportedFailure; in a host process, InputError or InternalError instead. Collective.
void together(const MpiSession& mpi, const std::function<void()>& work, CallSite at = CallSite());

/// Broadcasts the text of rank `from` to all. Collective.
void broadcast(const MpiSession& mpi, std::string& text, int from = 0, CallSite at = CallSite());

/// Runs `work`, which communicates. If it throws, the message is printed; with several ranks the others
/// cannot be waited for, and the whole job is aborted with the exit code.
void collectively(const MpiSession& mpi, const std::function<void()>& work);

}  // namespace kacanov
