// SPDX-License-Identifier: BSD-3-Clause
// How much memory a run takes, from what its arrays hold; and how much there is.
#pragma once

#include <cstdint>
#include <string>

#include <kacanov/mesh.hpp>
#include "case/case_file.hpp"

namespace kacanov {

struct ProblemSize {
  ElementType type = ElementType::tet4;
  double nodes = 0.0, elements = 0.0;
  double contact_points = 0.0;  ///< 0 where not known yet: they are few in 3D
  bool nonlinear = true;        ///< some law is not linear: the run takes tangents
  bool pressures = false;       ///< the multigrid has pressures: some material of tetrahedra is mixed
  bool may_flow = false;        ///< hexahedra that average: it has them from k0/g = 300 on
};

/// The same body where it flows far enough for pressures of hexahedra.
ProblemSize flowing(const ProblemSize& size);

/// Size of a model on a mesh, or on the one that `box` stands for, without its contact points.
ProblemSize size_of(const BoxSpec& box, const Model& model);
ProblemSize size_of(const Mesh& mesh, const Model& model);

/// What the arrays of a run hold, all ranks together, in bytes; see Part, Layout, StepContext,
/// Multigrid.
struct MemoryShares {
  double mesh = 0.0, problem = 0.0;  ///< on the first rank, until all have their parts
  double part = 0.0, operators = 0.0, loops = 0.0, multigrid = 0.0;
  double setup = 0.0;                ///< while the preconditioner is set up
  double step = 0.0, tangent = 0.0;  ///< while a Newton step is taken
};
MemoryShares memory_shares(const ProblemSize& size);

/// Sum over the ranks of their largest resident memories in bytes, with the default preconditioner: within 15
/// % from some 10,000 nodes on (measured). What `may_flow` is taken as not flowing that far.
double estimated_memory(const ProblemSize& size, int ranks);

/// Largest resident memory of this process so far, in bytes. 0: unknown.
std::uint64_t peak_memory();

/// Bytes that a new process could have: what the system calls available, less where a control group allows
/// less. 0: unknown.
double available_memory();

/// Throws InputError where `ranks_here` of the `ranks` ranks of a run of this size would not fit on this
/// machine, with both numbers.
void refuse_what_cannot_fit(const ProblemSize& size, int ranks, int ranks_here);

/// Whether such a run, that may flow, would not fit once it does.
bool may_outgrow(const ProblemSize& size, int ranks, int ranks_here);

/// What to say of it.
std::string outgrown_memory_message(const ProblemSize& size, int ranks, int ranks_here);

}  // namespace kacanov
