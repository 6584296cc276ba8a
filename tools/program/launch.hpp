// SPDX-License-Identifier: BSD-3-Clause
// How many processes and threads a run gets, and starting it under mpiexec.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "case/case_file.hpp"

namespace kacanov {

/// True where mpiexec, srun or the like started this process as one of a group.
bool started_by_mpi();

/// Cores this process may use: physical ones, within its affinity mask and its control group's quota.
int usable_cores();

struct Shape {
  int ranks = 1, threads = 1;
};

/// Below this many unknowns one process is as fast as several.
constexpr std::int64_t small_problem = 30000;

/// Ranks and threads for a case, from what the user gave: small cases get one rank, others one on each core.
Shape choose_shape(const Case& input, std::optional<int> ranks, std::optional<int> threads, int cores);

/// Unknowns of the case: exact for a generated box, from the size of the file otherwise. Reads nothing.
std::int64_t estimate_unknowns(const MeshSource& mesh);

/// Bytes that this process may map (ulimit -v); nothing where there is no limit.
std::optional<std::uintmax_t> address_space_limit();

/// Path of mpiexec on PATH; empty where there is none.
std::string find_mpiexec();

/// The file of this program. `link`: what /proc says; without it, the file as the system started it.
std::string own_executable(const char* link = "/proc/self/exe");

/// What run_under_mpiexec gives to the ranks.
struct HandedDown {
  std::span<const char* const> arguments;  ///< of this program, its own name first
  std::string case_text;                   ///< the first rank finds it in its standard input
  std::filesystem::path folder;            ///< for Open MPI's files where no temporary folder can be written
};

/// Runs this program on several ranks under mpiexec and waits for it. Returns the program's exit code. A
/// signal that ends this process ends the others as well. Throws InternalError where a process died,
/// InputError where a limit on the address space is too narrow for MPI to start.
int run_under_mpiexec(const std::string& mpiexec, Shape shape, const HandedDown& handed);

/// The case for the first rank: what run_under_mpiexec has sent, or the file where somebody else started the
/// ranks. Throws as read_case_text.
CaseText case_text_handed_down(const std::string& path);

/// What a process that was started by run_under_mpiexec has to leave with, so that its exit code cannot be
/// taken for one of mpiexec's own.
int coded_exit(int exit_code);

/// Settings that keep one MPI process, or several on one machine, quiet and working (also as root in a
/// container); what the user has set stays. To be called before MPI_Init or mpiexec.
void set_mpi_environment();

}  // namespace kacanov
