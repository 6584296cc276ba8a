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
/// Writes into the output folder, made if missing, a result.json with why a run broke down, unless another
/// run is writing there. For what happens before run_command() has the folder to itself.
void leave_failure(const Command& command, const Case& input, const std::string& text);

/// The result.json there is before a run.
class ResultMark {
 public:
  ResultMark(const Command& command, const Case& input);
  /// The same as leave_failure(), for a run of which no process is left: the numbers that it has written stay
  /// beside the message, those of a run before it do not.
  void leave(const std::string& text) const;

 private:
  std::filesystem::file_time_type written() const;

  std::filesystem::path folder_;
  std::filesystem::file_time_type before_;
};

int spectrum_command(const Command& command, const Case& input, const MpiSession& mpi);
/// Not converged means here that no penalty led to convergence.
int sweep_command(const Command& command, const Case& input, const MpiSession& mpi);
/// The rest needs no MPI: everything happens on one rank. `ranks`: those of the run to be foreseen.
int check_command(const Case& input, int ranks);
int partition_command(const Command& command, const Case& input);
/// Not converged means here that the answer does not fulfil its tolerance, or is not what the result says.
int verify_command(const Command& command, const Case& input);

/// These two make a case or a mesh, and read none.
int convert_command(const Command& command);
int init_command(const Command& command);

/// Whether the name is that of a deck, and not of a case.
bool names_deck(const std::string& path);
/// For a run of a deck: makes its case and mesh in the folder of the run, as convert_command does, and
/// returns the command for that case.
Command with_case_of_deck(Command command);

}  // namespace kacanov
