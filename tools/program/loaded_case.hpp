// SPDX-License-Identifier: BSD-3-Clause
// From a case and its mesh to a problem on the first rank and parts on all.
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

/// Ranks of a run, and how many of them share this machine's memory. 0 here: memory is not checked.
struct RankCount {
  int all = 1, here = 1;
};

/// Reads the mesh and puts the model on it, after checking that the one fits the other, and the run the
/// memory.
Problem load_problem(const Case& input, RankCount ranks);

/// Those of the case and of its problem, on standard error.
void print_warnings(const Case& input, const Problem& problem);

/// A problem split over the ranks.
struct LoadedCase {
  std::optional<Problem> problem;  ///< on the first rank
  std::vector<std::int32_t>
      boundary_nodes;  ///< there, after keep_boundary: their numbers in the whole problem
  Fingerprint print;   ///< likewise: of the whole problem
  Part part;
  std::vector<std::string> set_names;  ///< of ElementSets, on the first rank
  SetNumbers sets;                     ///< of the part's elements
  double read_seconds = 0.0, distribute_seconds = 0.0;
};

/// Takes the fingerprint and frees what of the problem the parts have taken over, see
/// keep_boundary(Problem&).
void keep_boundary(LoadedCase& loaded);

/// Collective; prints warnings. What is wrong with the input ends as together() says, on all ranks. `phase`
/// as RunOptions::phase.
LoadedCase load_case(const Case& input, const MpiSession& mpi, bool memory_check = true,
                     const std::function<void(const std::string&)>& phase = {});

/// Threads a rank: as the command says, else OMP_NUM_THREADS, else 1.
int threads_of(const Command& command);

}  // namespace kacanov
