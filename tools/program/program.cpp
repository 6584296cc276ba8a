// SPDX-License-Identifier: BSD-3-Clause
// Entry point of the program: parses the command line, starts its processes and calls a subcommand.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <vector>

#include <kacanov/error.hpp>
#include "program/command.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/launch.hpp"
#include "program/mpi_folder.hpp"
#include "program/output_folder.hpp"
#include "program/parallel.hpp"
#include "program/part_files.hpp"

namespace {

using namespace kacanov;

/// Returns whether the command runs on one rank, without MPI.
bool needs_one(const Command& command) {
  return command.kind == Command::Kind::check || command.kind == Command::Kind::partition ||
         command.kind == Command::Kind::verify;
}

/// `ranks`: number of ranks that a run would have here.
int command_on_one(const Command& command, const Case& input, int ranks) {
  if (command.kind == Command::Kind::check) return check_command(input, command.ranks.value_or(ranks));
  return command.kind == Command::Kind::verify ? verify_command(command, input)
                                               : partition_command(command, input);
}

int dispatch(const Command& command, const Case& input, MpiSession& mpi) {
  switch (command.kind) {
    case Command::Kind::run: return run_command(command, input, mpi);
    case Command::Kind::spectrum: return spectrum_command(command, input, mpi);
    case Command::Kind::sweep: return sweep_command(command, input, mpi);
    case Command::Kind::check:
    case Command::Kind::partition:
    case Command::Kind::verify:
    case Command::Kind::convert:
    case Command::Kind::init: break;
  }
  int code = exit_converged;
  together(mpi, [&] {
    if (mpi.first()) code = command_on_one(command, input, mpi.ranks());
  });
  mpi.expect_all_here();
  MPI_Bcast(&code, 1, MPI_INT, 0, mpi.comm());
  return code;
}

/// Runs under MPI with the existing ranks.
int run_here(const Command& command, const std::optional<Case>& known) {
  take_signals();
  std::optional<Case> input = known;
  MpiSession mpi([&](const Failure& failure) {
    if (failure.exit_code == exit_failure && input && command.kind == Command::Kind::run)
      leave_failure(command, *input, failure.text);
  });
  try {
    CaseText text{command.case_file, {}};
    together(mpi, [&] {
      if (!needs_one(command) && command.ranks && *command.ranks != mpi.ranks()) {
        throw InputError("--ranks: " + std::to_string(*command.ranks) + " asked for, but " +
                         std::to_string(mpi.ranks()) + " were started");
      }
      // Only the first rank reads the file: if it changed meanwhile, the ranks would have different cases.
      if (!input && mpi.first()) text = case_text_handed_down(command.case_file);
    });
    if (!input) {
      broadcast(mpi, text.text);
      together(mpi, [&] { input = parse_case(text, command.changes()); });
    }
    int code = exit_converged;
    collectively(mpi, [&] { code = dispatch(command, *input, mpi); });
    return code;
  } catch (const ReportedFailure& failure) {
    return failure.exit_code;
  }
}

int command_without_case(const Command& command) {
  return command.kind == Command::Kind::convert ? convert_command(command) : init_command(command);
}

/// Runs a command without a case on the first of the existing ranks.
int first_without_case(const Command& command) {
  const MpiSession mpi;
  int code = exit_converged;
  try {
    together(mpi, [&] {
      if (mpi.first()) code = command_without_case(command);
    });
  } catch (const ReportedFailure& failure) {
    return failure.exit_code;
  }
  return code;
}

/// Number of ranks on the command line, or the number of parts.
std::optional<int> ranks_asked_for(const Command& command, const Case& input) {
  if (command.parts.empty()) return command.ranks;
  const int parts = count_parts(command.parts, input);
  if (command.ranks.value_or(parts) != parts) {
    throw InputError("--ranks: expected " + std::to_string(parts) + ", as many as there are parts in " +
                     command.parts + ", got " + std::to_string(*command.ranks));
  }
  return parts;
}

/// Runs alone or under mpiexec, on as many ranks as the case and the command line require.
int run_on_ranks(const Command& command, const Case& input, const CaseText& text,
                 std::span<const char* const> words) {
  const Shape shape = choose_shape(input, ranks_asked_for(command, input), command.threads, usable_cores());
  const std::filesystem::path folder = output_folder(command, input);
  if (shape.ranks > 1) {
    const std::string mpiexec = find_mpiexec();
    if (!mpiexec.empty()) return run_under_mpiexec(mpiexec, shape, {words, text.text, folder});
    if (command.ranks)
      throw InputError("--ranks: mpiexec is not on the PATH; without it there is only one rank");
    std::cerr << "kacanov: note: mpiexec is not on the PATH; running on one rank\n";
  }
  const MpiFolder mpi_folder(folder);
  set_mpi_environment();
  return run_here(command, input);
}

/// Started by hand: runs the quick checks, then continues alone or under mpiexec.
int run_alone(const Command& given, int argc, const char* const* argv) {
  if (given.without_case()) return command_without_case(given);
  Command command = given;
  std::vector<const char*> words(argv, argv + argc);
  if (command.kind == Command::Kind::run && names_deck(given.case_file)) {
    command = with_case_of_deck(given);
    std::replace_if(
        words.begin() + 1, words.end(), [&](const char* word) { return word == given.case_file; },
        command.case_file.c_str());
    if (given.output.empty()) words.insert(words.end(), {"--output", command.output.c_str()});
  }
  const CaseText text = read_case_text(command.case_file);
  const Case input = parse_case(text, command.changes());
  if (needs_one(command)) {
    take_signals();
    const Shape shape = choose_shape(input, command.ranks, command.threads, usable_cores());
    return command_on_one(command, input, shape.ranks);
  }
  if (command.kind != Command::Kind::run) return run_on_ranks(command, input, text, words);
  const ResultMark before(command, input);
  try {
    return run_on_ranks(command, input, text, words);
  } catch (...) {
    // If a process was killed, the others ended too, and only this one can still record the reason.
    const Failure failure = current_failure();
    if (failure.exit_code == exit_failure) before.leave(failure.text);
    throw;
  }
}

/// Returns whether the command writes its results to files, with standard output as an addition.
bool writes_files(const std::optional<Command>& command) {
  return command && command->kind != Command::Kind::check && command->kind != Command::Kind::spectrum &&
         command->kind != Command::Kind::verify;
}

std::atomic<bool> out_of_memory = false;

[[noreturn]] void note_lack_of_memory() {
  out_of_memory = true;
  throw std::bad_alloc();
}

/// Last resort: without memory, even destroying a JSON document may allocate, and throw where nothing may
/// throw. Allocates nothing.
[[noreturn]] void end_at_once() {
  const char* what = out_of_memory ? "out of memory" : "a failure of a failure";
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    what = "out of memory";
  } catch (const std::exception& error) {
    what = error.what();
  } catch (...) {
  }
  for (const char* text : {"kacanov: internal failure: ", what, "\n"})
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  _exit(coded_exit(exit_failure));
}

int say(const ParsedCommand& parsed) {
  std::cout << parsed.output << std::flush;
  std::cerr << parsed.error << std::flush;
  return parsed.exit_code;
}

int run_program(int argc, char** argv) {
  std::set_terminate(end_at_once);
  std::set_new_handler(note_lack_of_memory);
  // Exceeding the file size limit is an error like a full disk; a closed output pipe does not stop a run
  // whose results go to files.
  for (const int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
  const ParsedCommand parsed = parse_command(argc, argv);
  try {
    if (started_by_mpi()) {
      if (parsed.command && parsed.command->without_case()) return first_without_case(*parsed.command);
      if (parsed.command) return coded_exit(run_here(*parsed.command, std::nullopt));
      const MpiSession mpi;
      return mpi.first() ? say(parsed) : parsed.exit_code;
    }
    const int code = parsed.command ? run_alone(*parsed.command, argc, argv) : say(parsed);
    if ((!std::cout.flush() || std::ferror(stdout) != 0) && !writes_files(parsed.command))
      throw InternalError("the standard output cannot be written");
    return code;
  } catch (...) {
    const Failure failure = current_failure();
    print_failure(failure);
    return failure.exit_code;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int code = run_program(argc, argv);
  if (!address_space_limit()) return code;
  // If threads of OpenBLAS cannot allocate memory, they retry forever, and exit() would wait for them.
  std::cout.flush();
  std::fflush(nullptr);
  std::_Exit(code);
}
