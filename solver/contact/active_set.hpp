// SPDX-License-Identifier: BSD-3-Clause
// One primal–dual active set (semismooth Newton) step for contact and friction, Coulomb's and the disc in 3D
// included.
#pragma once

#include <functional>
#include <span>

#include "contact/admm.hpp"
#include "contact/trace_rows.hpp"

namespace kacanov {

/// What each contact point does in the step: decided by λ + c(Cu − ρ), as in the projections of ADMM.
struct ActiveSet {
  std::vector<TraceChoice> held;  ///< normal: touches; tangential: sticks
  Vector slip_force;              ///< points × 2: ψ ŝ where it slips, without what follows the pressure
  Vector slip_stiffness;          ///< points: k of λ_t = (ψ + μ_f λ_n) ŝ + k (I − ŝŝᵀ) Tu, 0 in 2D
  Vector slip_direction;          ///< points × 2: ŝ
  Vector coulomb;                 ///< points: μ_f where it slips under pressure, else 0

  /// Nothing held, and nothing slips.
  explicit ActiveSet(std::size_t points = 0)
      : held(points),
        slip_force(2 * points, 0.0),
        slip_stiffness(points, 0.0),
        slip_direction(2 * points, 0.0),
        coulomb(points, 0.0) {}
};

/// c is a penalty like ADMM's; any positive value has the same fixed points.
ActiveSet decide(const Traces& traces, const ContactState& state, double c);

/// Slip stiffness k M (I − ŝŝᵀ) as blocks of owned nodes, for a preconditioner. Collective.
std::vector<NodeBlock> slip_blocks(const Part& part, const ActiveSet& set);

struct ActiveSetStep {
  Vector delta;  ///< the step, unknowns of the part
  std::int64_t cg_iterations = 0;
  double cg_digits = 0.0;
  bool solved = false;     ///< CG met its tolerance
  double curvature = 0.0;  ///< δᵀ B δ of the linear model
  /// The same with the force that friction lets through: what the residual falls by along δ. Of it, by what
  /// slips.
  double slope = 0.0, turning = 0.0;
  double closing = 0.0;  ///< the largest displacement that closes a gap or undoes a slip of held rows
};

/// Solves the linearised problem with the rows of `set` held: B δ + slip terms = F − R(u) − CᵀMλ, Cu + Cδ on
/// the obstacle or at rest. On entry `work.residual` is F − R(u), without contact forces. Of the options
/// `relative` alone says little: points moved onto the obstacle one by one strain the elements beside them
/// beyond anything else, so `most` should be what was unbalanced before. Collective.
ActiveSetStep active_set_step(const LinearProblem& problem, const Part& part, const ActiveSet& set,
                              const ContactState& state, const CgOptions& options, CgWork& work);

/// Multipliers after a step: from the forces F − R(u) at held rows, from the friction law at slipping ones
/// (projected onto the disc), zero elsewhere. Uses state.trace at the new u; φ is set so that ADMM can go on
/// from here. `residual`, F − R(u), is used up.
void recover_multipliers(const Part& part, const Traces& traces, const ActiveSet& set,
                         std::span<double> residual, ContactState& state);

}  // namespace kacanov
