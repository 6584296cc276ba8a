// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of the program. Each returns an exit code and throws InputError, InternalError or
// ReportedFailure.
#pragma once

#include "case/case_file.hpp"
#include "program/command.hpp"
#include "program/parallel.hpp"

namespace kacanov {

int run_command(const Command& command, const Case& input, MpiSession& mpi);
/// Leaves a result.json that says why a run broke down, for a run of which no process was left to do so.
/// Where there is one, it stays.
void leave_failure(const Command& command, const Case& input, const std::string& text);
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
