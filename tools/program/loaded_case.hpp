// SPDX-License-Identifier: BSD-3-Clause
// Reads a case and its mesh into a problem on the first rank and parts on all ranks.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <kacanov/checkpoint.hpp>
#include <kacanov/part.hpp>
#include "case/case_file.hpp"
#include "program/command.hpp"
#include "program/element_sets.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// Reads or generates the mesh.
Mesh load_mesh(const MeshSource& source);

/// Ranks of a run, and how many of them share this machine's memory; here = 0: no memory check.
struct RankCount {
  int all = 1, here = 1;
};

/// Reads the mesh and applies the model, after checking that model and mesh match and that the run fits into
/// memory.
Problem load_problem(const Case& input, RankCount ranks);

/// Prints the warnings of the case and of its problem to standard error.
void print_warnings(const Case& input, const Problem& problem);

/// A problem distributed over the ranks.
struct LoadedCase {
  std::optional<Problem> problem;  ///< on the first rank
  std::vector<std::int32_t>
      boundary_nodes;  ///< after keep_boundary(), on the first rank: their numbers in the whole problem
  Fingerprint print;   ///< likewise: fingerprint of the whole problem
  Part part;
  std::vector<std::string> set_names;  ///< ElementSets::names, on the first rank
  SetNumbers sets;                     ///< of the elements of this rank's part
  double read_seconds = 0.0, distribute_seconds = 0.0;
};

/// Stores the fingerprint and frees the data that the parts have taken over, see keep_boundary(Problem&).
void keep_boundary(LoadedCase& loaded);

/// Loads and distributes a case and prints warnings. Input errors are handled on all ranks as in together().
/// `phase` as RunOptions::phase. Collective.
LoadedCase load_case(const Case& input, const MpiSession& mpi, bool memory_check = true,
                     const std::function<void(const std::string&)>& phase = {});

/// Threads per rank: from the command, else OMP_NUM_THREADS, else 1.
int threads_of(const Command& command);

}  // namespace kacanov
