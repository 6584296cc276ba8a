// SPDX-License-Identifier: BSD-3-Clause
// Linearisation error of a Newton step.
#pragma once

#include "contact/admm.hpp"
#include "contact/contact_state.hpp"

namespace kacanov {

/// Returns the norm of the linearisation error: the nonlinear residual at state.u + δ minus that of the
/// linear problem, for the current CG iterate δ (theory: left-out). `subtract(trace, f)`: f −= contact forces
/// at these traces. Uses work.image; work.residual is that of the linear problem. Collective.
template <class Subtract>
double left_out(const LinearProblem& problem, const Space& space, const ContactState& state,
                std::span<const double> delta, CgWork& work, const Subtract& subtract) {
  Vector& there = work.image;  // A p and M⁻¹ r are no longer needed
  for (std::size_t i = 0; i < there.size(); ++i) there[i] = state.u[i] + delta[i];
  Vector rest(there.size());
  problem.unbalanced(there, rest);
  ContactValues trace(problem.traces->size());
  state.evaluate(*problem.traces, there, trace);
  subtract(trace, rest);
  space.project(rest);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= work.residual[i];
  return space.residual_norm(rest);
}

}  // namespace kacanov
