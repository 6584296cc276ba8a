// SPDX-License-Identifier: BSD-3-Clause
// One primal–dual active set (semismooth Newton) step for contact and friction, Coulomb's and the disc in 3D
// included.
#pragma once

#include <span>

#include "contact/active_set.hpp"

namespace kacanov {

/// Slip stiffness k M (I − ŝŝᵀ) as blocks of owned nodes, for a preconditioner. Collective.
std::vector<NodeBlock> slip_blocks(const Part& part, const ActiveSet& set);

struct ActiveSetStep {
  Vector delta;  ///< the step, unknowns of the part
  std::int64_t cg_iterations = 0;
  double cg_digits = 0.0;
  bool solved = false;     ///< far enough for the step to be worth taking
  bool met = false;        ///< its tolerance
  double curvature = 0.0;  ///< δᵀ B δ of the linear model
  /// The same with the force that friction lets through: what the residual falls by along δ. Of it, by what
  /// slips.
  double slope = 0.0, turning = 0.0;
  double closing = 0.0;  ///< the largest displacement that closes a gap or undoes a slip of held rows
};

/// Solves the linearised problem with the rows of `set` held: B δ + slip terms = F − R(u) − CᵀMλ, Cu + Cδ on
/// the obstacle or at rest. Of the options
/// `relative` alone says little: points moved onto the obstacle one by one strain the elements beside them
/// beyond anything else, so `most` should be what was unbalanced before. Collective.
ActiveSetStep active_set_step(const LinearProblem& problem, const Part& part, const ActiveSet& set,
                              const ContactState& state, CgOptions options, CgWork& work);

/// Multipliers after a step: from the forces F − R(u) at held rows, from the friction law at slipping ones
/// (projected onto the disc), zero elsewhere. Uses state.trace at the new u; φ is set so that ADMM can go on
/// from here. `residual`, F − R(u), is used up.
void recover_multipliers(const Part& part, const Traces& traces, const ActiveSet& set,
                         std::span<double> residual, ContactState& state);

}  // namespace kacanov
