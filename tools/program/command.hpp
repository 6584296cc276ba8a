// SPDX-License-Identifier: BSD-3-Clause
// Parsed command line of the program.
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
  std::string parts;                    ///< run: folder written by `partition`; empty: none
  std::optional<int> ranks, threads;    ///< partition: `ranks` is the number of parts, always set
  std::string preset;                   ///< --preset; empty: as the case says
  std::vector<std::string> overrides;   ///< --set
  std::optional<double> tolerance;      ///< spectrum: relative tolerance for λ_min and λ_max
  bool restart = false;                 ///< run: continue from the checkpoint in the folder
  bool memory_check = true;             ///< run: refuse a run that does not fit into memory
  bool quiet = false, verbose = false;  ///< run: print errors and warnings only; print every phase
  double stop_within = 30.0;            ///< run: seconds after a stop signal until the process is ended
  bool json = false;                    ///< spectrum: print JSON
  std::optional<double> r_min, r_max;   ///< sweep
  int points = 21;                      ///< sweep
  std::string from, to;                 ///< convert, init: files; `to` may be empty
  bool leave_out = false;               ///< convert, run of a deck: skip unsupported keywords
  bool force = false;                   ///< convert, init: overwrite existing files

  /// Returns the changes to the case: --preset first, so that --set overrules it.
  std::vector<std::string> changes() const {
    std::vector<std::string> all;
    if (!preset.empty()) all.push_back("solver.preset=" + preset);
    all.insert(all.end(), overrides.begin(), overrides.end());
    return all;
  }
  /// Returns whether the command reads no case.
  bool without_case() const noexcept { return kind == Kind::convert || kind == Kind::init; }
};

/// The parsed command, or a text to print and the exit code.
struct ParsedCommand {
  std::optional<Command> command;
  std::string output, error;
  int exit_code = 0;
};
ParsedCommand parse_command(int argc, const char* const* argv);

/// The exit codes of the program.
enum ExitCode : int { exit_converged = 0, exit_not_converged = 1, exit_bad_input = 2, exit_failure = 3 };

}  // namespace kacanov
