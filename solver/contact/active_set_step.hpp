// SPDX-License-Identifier: BSD-3-Clause
// One primal–dual active set (semismooth Newton) step for contact and friction, with Coulomb friction and the
// friction disc in 3D.
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
  bool solved = false;     ///< accurately enough for the step to be useful
  bool met = false;        ///< whether it met its tolerance
  double curvature = 0.0;  ///< δᵀ B δ of the linear model
  /// The same with the pressure-dependent friction force: the decrease of the residual along δ; and the part
  /// of it due to slip stiffness.
  double slope = 0.0, turning = 0.0;
  double closing = 0.0;  ///< largest displacement that closes a gap or undoes the slip of held rows
};

/// Solves the linearised problem with the rows of `set` held: B δ + slip terms = F − R(u) − CᵀMλ, with Cu +
/// Cδ on the obstacle or at rest. Points moved onto the obstacle inflate the first residual, so set
/// options.most to the previous unbalanced force besides `relative`. Collective.
ActiveSetStep active_set_step(const LinearProblem& problem, const Part& part, const ActiveSet& set,
                              const ContactState& state, CgOptions options, CgWork& work);

/// Computes the multipliers after a step: from the forces F − R(u) at held rows, from the friction law at
/// slipping points (projected onto the disc), zero elsewhere. Uses state.trace at the new u; sets φ so that
/// ADMM can continue. `residual`, F − R(u), is overwritten.
void recover_multipliers(const Part& part, const Traces& traces, const ActiveSet& set,
                         std::span<double> residual, ContactState& state);

}  // namespace kacanov
