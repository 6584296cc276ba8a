// SPDX-License-Identifier: BSD-3-Clause
// The command line of the program.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kacanov {

struct Command {
  enum class Kind { run, spectrum, sweep, check, partition, verify, convert, init };
  Kind kind = Kind::run;
  std::string case_file;
  std::string output;                   ///< folder; empty: results/<case name>
  std::string parts;                    ///< run: folder that `partition` has written; empty: none
  std::optional<int> ranks, threads;    ///< of partition: `ranks` is the number of parts, and always there
  std::vector<std::string> overrides;   ///< --set
  std::optional<double> tolerance;      ///< spectrum: relative, on λ_min and λ_max
  bool restart = false;                 ///< run: go on from the checkpoint in the folder
  bool memory_check = true;             ///< run: refuse what does not fit
  bool quiet = false, verbose = false;  ///< run: errors and warnings alone; every phase
  double stop_within = 30.0;            ///< run: seconds from a signal until it is ended all the same
  bool json = false;                    ///< spectrum: print JSON
  std::optional<double> r_min, r_max;   ///< sweep
  int points = 21;                      ///< sweep
  std::string from, to;                 ///< convert, init: files; `to` may be empty
  bool leave_out = false;               ///< convert, run of a deck: makes a case without what is not known
  bool force = false;                   ///< convert, init: writes over files that are there

  /// Whether there is no case to be read.
  bool without_case() const noexcept { return kind == Kind::convert || kind == Kind::init; }
};

/// What the command line asks for, or a text to print and the exit code to leave with.
struct ParsedCommand {
  std::optional<Command> command;
  std::string output, error;
  int exit_code = 0;
};
ParsedCommand parse_command(int argc, const char* const* argv);

/// The exit codes of the program.
enum ExitCode : int { exit_converged = 0, exit_not_converged = 1, exit_bad_input = 2, exit_failure = 3 };

}  // namespace kacanov
