// SPDX-License-Identifier: BSD-3-Clause
// Estimates the memory of a run from its arrays, and returns the available memory.
#pragma once

#include <cstdint>
#include <string>

#include <kacanov/mesh.hpp>
#include "case/case_file.hpp"

namespace kacanov {

struct ProblemSize {
  ElementType type = ElementType::tet4;
  double nodes = 0.0, elements = 0.0;
  double contact_points = 0.0;  ///< 0 if not known yet: there are few in 3D
  bool nonlinear = true;        ///< a law is nonlinear: the run stores tangents
  bool pressures = false;       ///< a mixed material of tetrahedra: the multigrid includes pressures
  bool may_flow = false;        ///< hexahedra with averaged dilatation: pressures from k0/g = 300 on
};

/// Returns the size once plastic flow makes the multigrid include pressures of hexahedra.
ProblemSize flowing(const ProblemSize& size);

/// Returns the size of a model on a mesh, or on the mesh of a box, without contact points.
ProblemSize size_of(const BoxSpec& box, const Model& model);
ProblemSize size_of(const Mesh& mesh, const Model& model);

/// Bytes of the arrays of a run, summed over the ranks; see Part, Layout, StepContext, Multigrid.
struct MemoryShares {
  double mesh = 0.0, problem = 0.0;  ///< on the first rank, until the parts are distributed
  double part = 0.0, operators = 0.0, loops = 0.0, multigrid = 0.0;
  double setup = 0.0;                ///< during preconditioner setup
  double step = 0.0, tangent = 0.0;  ///< during a Newton step
};
MemoryShares memory_shares(const ProblemSize& size);

/// Returns the sum over the ranks of their peak resident memory in bytes with the default preconditioner:
/// within 15 % from about 10,000 nodes on (measured). A problem with `may_flow` counts as not flowing.
double estimated_memory(const ProblemSize& size, int ranks);

/// Peak resident memory of this process so far in bytes. 0: unknown.
std::uint64_t peak_memory();

/// Bytes available to a new process: available memory of the system, or less if a control group limits it. 0:
/// unknown.
double available_memory();

/// Throws InputError with both numbers if `ranks_here` of the `ranks` ranks of a run of this size do not fit
/// into the memory of this machine.
void refuse_what_cannot_fit(const ProblemSize& size, int ranks, int ranks_here);

/// Returns whether a run that may flow would no longer fit once it does.
bool may_outgrow(const ProblemSize& size, int ranks, int ranks_here);

/// Warning for that case.
std::string outgrown_memory_message(const ProblemSize& size, int ranks, int ranks_here);

}  // namespace kacanov
