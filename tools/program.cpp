// SPDX-License-Identifier: BSD-3-Clause
// The program kacanov: reads the command line, sees to its processes and hands over to a subcommand.
#include <iostream>
#include <optional>

#include "command.hpp"
#include "commands.hpp"
#include "error.hpp"
#include "launch.hpp"
#include "parallel.hpp"

namespace {

using namespace kacanov;

int dispatch(const Command& command, const Case& input, const MpiSession& mpi) {
  switch (command.kind) {
    case Command::Kind::run: return run_command(command, input, mpi);
    case Command::Kind::spectrum: return spectrum_command(command, input, mpi);
    case Command::Kind::sweep: return sweep_command(command, input, mpi);
    case Command::Kind::check: break;
  }
  together(mpi, [&] {
    if (mpi.first()) check_command(input, mpi.ranks());
  });
  return exit_converged;
}

/// Within MPI, with the ranks there are.
int run_here(const Command& command, const std::optional<Case>& known) {
  const MpiSession mpi;
  try {
    std::optional<Case> input = known;
    together(mpi, [&] {
      if (command.ranks && *command.ranks != mpi.ranks()) {
        throw InputError("--ranks: " + std::to_string(*command.ranks) + " asked for, but " +
                         std::to_string(mpi.ranks()) + " were started");
      }
      // Every rank reads the few lines of the case file; the mesh is the first one's.
      if (!input) input = read_case(command.case_file, command.overrides);
    });
    return dispatch(command, *input, mpi);
  } catch (const ReportedFailure& failure) {
    return failure.exit_code;
  }
}

/// Started by hand: validates what is quickly validated, then goes on alone or under mpiexec.
int run_alone(const Command& command, int argc, const char* const* argv) {
  const Case input = read_case(command.case_file, command.overrides);
  check_supported(input.model.solver);
  Shape shape = choose_shape(input, command.ranks, command.threads, usable_cores());
  if (command.kind == Command::Kind::check) return check_command(input, shape.ranks);
  if (shape.ranks > 1) {
    const std::string mpiexec = find_mpiexec();
    if (!mpiexec.empty()) return run_under_mpiexec(mpiexec, shape, argc, argv);
    if (command.ranks)
      throw InputError("--ranks: mpiexec is not on the PATH; without it there is only one rank");
    std::cerr << "kacanov: note: mpiexec is not on the PATH; running on one rank\n";
  }
  set_mpi_environment();
  return run_here(command, input);
}

int say(const ParsedCommand& parsed) {
  std::cout << parsed.output << std::flush;
  std::cerr << parsed.error << std::flush;
  return parsed.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  const ParsedCommand parsed = parse_command(argc, argv);
  try {
    if (started_by_mpi()) {
      if (parsed.command) return coded_exit(run_here(*parsed.command, std::nullopt));
      const MpiSession mpi;
      return mpi.first() ? say(parsed) : parsed.exit_code;
    }
    return parsed.command ? run_alone(*parsed.command, argc, argv) : say(parsed);
  } catch (...) {
    const Failure failure = current_failure();
    print_failure(failure);
    return failure.exit_code;
  }
}
