// SPDX-License-Identifier: BSD-3-Clause
// Chooses the number of processes and threads of a run, and starts it under mpiexec.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "case/case_file.hpp"

namespace kacanov {

/// Returns true if mpiexec, srun or the like started this process as part of a group.
bool started_by_mpi();

/// Returns the number of physical cores this process may use, within its affinity mask and control group
/// quota.
int usable_cores();

struct Shape {
  int ranks = 1, threads = 1;
};

/// Below this number of unknowns one process is as fast as several.
constexpr std::int64_t small_problem = 30000;

/// Returns ranks and threads for a case and the user's options: small cases get one rank, others one per
/// core.
Shape choose_shape(const Case& input, std::optional<int> ranks, std::optional<int> threads, int cores);

/// Returns the unknowns of the case: exact for a box, estimated from the file size otherwise. Reads no file
/// content.
std::int64_t estimate_unknowns(const MeshSource& mesh);

/// Address space limit in bytes (ulimit -v); nothing if unlimited.
std::optional<std::uintmax_t> address_space_limit();

/// Path of mpiexec on PATH; empty if there is none.
std::string find_mpiexec();

/// Path of this program. `link`: usually /proc/self/exe; if unreadable, the path the system started it with.
std::string own_executable(const char* link = "/proc/self/exe");

/// Input of the ranks that run_under_mpiexec() starts.
struct HandedDown {
  std::span<const char* const> arguments;  ///< of this program, including its own name
  std::string case_text;                   ///< standard input of the first rank
  std::filesystem::path folder;            ///< for Open MPI's files if no temporary folder is writable
};

/// Runs this program on several ranks under mpiexec and waits for it. Returns the exit code of the program. A
/// signal that ends this process also ends the ranks. Throws InternalError if a process died, InputError if
/// the address space limit is too small for MPI to start.
int run_under_mpiexec(const std::string& mpiexec, Shape shape, const HandedDown& handed);

/// Returns the case on the first rank: sent by run_under_mpiexec(), or read from the file if the ranks were
/// started otherwise. Throws as read_case_text() does.
CaseText case_text_handed_down(const std::string& path);

/// Returns the exit code for a process started by run_under_mpiexec(), offset so that it differs from
/// mpiexec's own.
int coded_exit(int exit_code);

/// Sets environment variables that keep MPI quiet and working with one process or several on one machine
/// (also as root in a container); variables set by the user stay. Call it before MPI_Init or mpiexec.
void set_mpi_environment();

}  // namespace kacanov
