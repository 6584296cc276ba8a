// SPDX-License-Identifier: BSD-3-Clause
// Commands and options: the one source of parsing, --help, the manual page and shell completion.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <utility>

#include "program/command.hpp"

namespace kacanov {

/// Returns the command line parser, which fills `command` except for its kind.
std::unique_ptr<CLI::App> make_command_line(Command& command);

inline constexpr const char* what_it_does = "elastoplastic bodies in contact with rigid obstacles";
inline constexpr const char* about_processes =
    "Without --ranks a case of more than some 30,000 unknowns runs on all cores, a smaller one on one;\n"
    "under mpiexec or srun the program uses the processes it is given.";
using Meaning = std::pair<const char*, const char*>;
inline constexpr Meaning exit_codes[] = {{"0", "converged"},
                                         {"1", "not converged (all output is written)"},
                                         {"2", "bad input"},
                                         {"3", "internal failure"}};
inline constexpr Meaning environment[] = {
    {"KACANOV_INSTRUCTION_SET", "avx512, avx2 or plain: overrules the best there is"},
    {"KACANOV_THREADS", "own or openmp: whose threads share a process's work; own if not set"},
    {"NO_COLOR", "set to anything: no colour"},
    {"OMP_NUM_THREADS", "threads a process under mpiexec or srun"}};

std::vector<const CLI::App*> commands_of(const CLI::App& app);
std::vector<const CLI::Option*> options_of(const CLI::App& app);

/// Returns the manual page in groff format, as `man kacanov` shows it.
std::string manual_page(const CLI::App& app);
/// Returns a bash script that completes commands, options, files and the keys of --set.
std::string bash_completion(const CLI::App& app);

}  // namespace kacanov
