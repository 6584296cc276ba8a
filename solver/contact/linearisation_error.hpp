// SPDX-License-Identifier: BSD-3-Clause
// How far the linear problem of a Newton step is from the true one.
#pragma once

#include "contact/admm.hpp"
#include "contact/contact_state.hpp"

namespace kacanov {

/// The residual that the linear problem of a step from `state` leaves out, once CG has come to δ (theory:
/// left-out). `subtract(trace, f)`: f −= contact forces at the traces there. Uses the image of `work`, and
/// its residual is that of the linear problem. Collective.
template <class Subtract>
double left_out(const LinearProblem& problem, const Space& space, const ContactState& state,
                std::span<const double> delta, CgWork& work, const Subtract& subtract) {
  Vector& there = work.image;  // A p and M⁻¹ r are wanted no more
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
