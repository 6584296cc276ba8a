// SPDX-License-Identifier: BSD-3-Clause
// MPI from start to end of the program, and failures that all ranks learn of.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>
#include <utility>

#include <kacanov/mpi_communicator.hpp>

namespace kacanov {

/// Exit code and text of the exception being handled: 2 for InputError, else 3.
struct Failure {
  int exit_code = 0;
  std::string text;
  std::string cause = {};  ///< the same without "error: " and the like
};
Failure current_failure();

/// "kacanov: error: ..." on standard error.
void print_failure(const Failure& failure);

/// MPI_Init to MPI_Finalize; or, within a host that sees to these itself, some ranks of its own.
class MpiSession {
 public:
  /// `when_failing` as below.
  explicit MpiSession(std::function<void(const Failure&)> when_failing = {});
  /// Of a host's process: whoever is handed the session prints nothing, and together() throws on every rank
  /// what went wrong on one.
  explicit MpiSession(MPI_Comm comm);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  MPI_Comm comm() const noexcept { return comm_; }
  bool hosted() const noexcept { return hosted_; }
  int rank() const noexcept { return rank_; }
  int ranks() const noexcept { return ranks_; }
  bool first() const noexcept { return rank_ == 0; }
  /// Precedes calls of MPI by hand (Communicator::expect_all_here).
  void expect_all_here(CallSite at = CallSite()) const { all_.expect_all_here(at); }

  /// What else is to be done about a failure, on the rank that prints it. It must not communicate; what it
  /// throws is lost.
  void when_failing(std::function<void(const Failure&)> work) { when_failing_ = std::move(work); }
  /// Prints a failure and does that.
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

/// Does `work`, which must not communicate, on every rank; where it throws on any, one message is printed and
/// every rank throws ReportedFailure; in a host's process InputError or InternalError instead. Collective.
void together(const MpiSession& mpi, const std::function<void()>& work, CallSite at = CallSite());

/// Hands the text of one rank to all. Collective.
void broadcast(const MpiSession& mpi, std::string& text, int from = 0, CallSite at = CallSite());

/// Does `work`, which communicates. Where it throws, the message is printed; with several ranks the rest
/// cannot be waited for, and the whole job ends there with its exit code.
void collectively(const MpiSession& mpi, const std::function<void()>& work);

}  // namespace kacanov
