// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of the program. Each returns an exit code and throws InputError, InternalError or
// ReportedFailure.
#pragma once

#include <filesystem>

#include "case/case_file.hpp"
#include "program/command.hpp"
#include "program/parallel.hpp"

namespace kacanov {

int run_command(const Command& command, const Case& input, MpiSession& mpi);
/// Writes a result.json with the reason of a failure into the output folder, which is created if missing,
/// unless another run is writing there. For failures before run_command() has locked the folder.
void leave_failure(const Command& command, const Case& input, const std::string& text);

/// Remembers the result.json that existed before a run.
class ResultMark {
 public:
  ResultMark(const Command& command, const Case& input);
  /// Like leave_failure(), for a run whose processes have all ended: numbers that the run has written stay
  /// beside the message, numbers of an earlier run do not.
  void leave(const std::string& text) const;

 private:
  std::filesystem::file_time_type written() const;

  std::filesystem::path folder_;
  std::filesystem::file_time_type before_;
};

int spectrum_command(const Command& command, const Case& input, const MpiSession& mpi);
/// Not converged: the run converged for no penalty.
int sweep_command(const Command& command, const Case& input, const MpiSession& mpi);
/// The commands below need no MPI and use one rank. `ranks`: number of ranks of the planned run.
int check_command(const Case& input, int ranks);
int partition_command(const Command& command, const Case& input);
/// Not converged: the solution exceeds its tolerance or differs from the numbers in the result.
int verify_command(const Command& command, const Case& input);

/// These two create a case or a mesh and read none.
int convert_command(const Command& command);
int init_command(const Command& command);

/// Returns whether the name is that of a deck rather than a case.
bool names_deck(const std::string& path);
/// For a run of a deck: writes its case and mesh into the folder of the run, as convert_command() does, and
/// returns the command for that case.
Command with_case_of_deck(Command command);

}  // namespace kacanov
