// SPDX-License-Identifier: BSD-3-Clause
// One primal–dual active set (semismooth Newton) step for contact and Tresca friction.
#include "contact/active_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kacanov {
namespace {

/// k (I − ŝŝᵀ) w of a slipping point: what its friction resists turning with.
std::array<double, 2> turning_force(const ActiveSet& set, std::size_t i, const double* w) {
  const double* s = &set.slip_direction[2 * i];
  const double along = w[0] * s[0] + w[1] * s[1];
  return {set.slip_stiffness[i] * (w[0] - along * s[0]), set.slip_stiffness[i] * (w[1] - along * s[1])};
}

/// Force of the slipping points at the traces w: y −= Tᵀ M (ψŝ + k (I − ŝŝᵀ) w).
void subtract_slip_force(const Traces& traces, const ActiveSet& set, const Vector& tangential,
                         std::span<double> y) {
  ContactValues force(traces.size());
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto turning = turning_force(set, i, &tangential[2 * i]);
    for (std::size_t k = 0; k < 2; ++k) force.tangential[2 * i + k] = set.slip_force[2 * i + k] + turning[k];
  }
  traces.add_force(force, -1.0, y);
}

/// y += Tᵀ M k (I − ŝŝᵀ) T x. Returns this rank's share of what xᵀ y grows by.
double add_slip_stiffness(const Traces& traces, const ActiveSet& set, std::span<const double> x,
                          std::span<double> y) {
  ContactValues trace(traces.size());
  traces.evaluate(x, trace);
  double share = 0.0;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    double* w = &trace.tangential[2 * i];
    const auto turning = turning_force(set, i, w);
    if (i < traces.owned()) share += traces.points()[i].mass * (w[0] * turning[0] + w[1] * turning[1]);
    trace.normal[i] = 0.0;
    std::copy(turning.begin(), turning.end(), w);
  }
  traces.add_force(trace, 1.0, y);
  return share;
}

}  // namespace

ActiveSet decide(const Traces& traces, const ContactState& state, double c) {
  const auto points = traces.points();
  ActiveSet set;
  set.held.resize(points.size());
  set.slip_force.assign(2 * points.size(), 0.0);
  set.slip_stiffness.assign(points.size(), 0.0);
  set.slip_direction.assign(2 * points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    set.held[i].normal = state.lambda.normal[i] + c * (state.trace.normal[i] - state.gap[i]) > 0.0;
    if (points[i].tangents == 0) continue;
    const double* lambda = &state.lambda.tangential[2 * i];
    const double s[2] = {lambda[0] + c * state.trace.tangential[2 * i],
                         lambda[1] + c * state.trace.tangential[2 * i + 1]};
    const double length = std::hypot(s[0], s[1]), bound = state.bound[i];
    // What its friction has pushed back sticks before it may slip the other way: friction beyond what a
    // yielding body carries would throw it to and fro.
    const bool turned = lambda[0] * s[0] + lambda[1] * s[1] < 0.0;
    set.held[i].tangential = bound > 0.0 && (length <= bound || turned);
    if (set.held[i].tangential || length == 0.0) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      set.slip_direction[2 * i + k] = s[k] / length;
      set.slip_force[2 * i + k] = bound * s[k] / length;
    }
    if (points[i].tangents == 2) set.slip_stiffness[i] = c * bound / (length - bound);
  }
  return set;
}

std::vector<NodeBlock> slip_blocks(const Part& part, const ActiveSet& set) {
  const auto dim = static_cast<std::size_t>(part.dim());
  const WideNodes nodes(part);
  std::vector<NodeBlock> blocks;
  Vector wide = nodes.zeros(dim * dim);
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i) {
    if (set.slip_stiffness[i] == 0.0) continue;
    const double* s = &set.slip_direction[2 * i];
    const auto entries = part.contact.entries(i);
    for (const RowEntry& entry : entries) {
      NodeBlock block{entry.node, {}};
      Vector3 across{};  // the tangent orthogonal to the slip
      for (std::size_t c = 0; c < dim; ++c)
        across[c] = s[0] * entry.tangent[1][c] - s[1] * entry.tangent[0][c];
      for (std::size_t c = 0; c < dim; ++c)
        for (std::size_t d = 0; d < dim; ++d)
          block.value[c * dim + d] = part.contact[i].mass * set.slip_stiffness[i] * across[c] * across[d];
      if (entries.size() == 1) {
        blocks.push_back(block);
        continue;
      }
      double* sum = &wide[nodes.position(entry.node) * dim * dim];
      for (std::size_t k = 0; k < dim * dim; ++k) sum[k] += block.value[k];
    }
  }
  const auto summed = nodes.summed(std::move(wide));
  blocks.insert(blocks.end(), summed.begin(), summed.end());
  return blocks;
}

ActiveSetStep active_set_step(const LinearProblem& problem, const Part& part, const ActiveSet& set,
                              const ContactState& state, const CgOptions& options, CgWork& work,
                              std::span<double> delta) {
  const Traces& traces = *problem.traces;
  const TraceRows rows(part, set.held);
  Space space(part);
  rows.hold_in(space);

  // The held rows first: the smallest nodal displacement that closes the gap and undoes the slip.
  Vector closing(rows.local());
  std::size_t at = 0;
  double furthest = 0.0;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto& point = traces.points()[i];
    const double root = std::sqrt(point.mass);
    if (set.held[i].normal) closing[at++] = root * (state.gap[i] - state.trace.normal[i]);
    if (set.held[i].tangential)
      for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
        closing[at++] = -root * state.trace.tangential[2 * i + k];
  }
  for (const double v : closing) furthest = std::max(furthest, std::abs(v));
  furthest = part.halo.max_all(furthest);

  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    const double share = problem.apply(p, q);
    return share + add_slip_stiffness(traces, set, p, q);
  };
  subtract_slip_force(traces, set, state.trace.tangential, work.residual);
  rows.lift(closing, delta);
  if (furthest > 0.0) {
    apply(delta, work.image);
    for (std::size_t i = 0; i < delta.size(); ++i) work.residual[i] -= work.image[i];
  }
  const CgResult solve = conjugate_gradients(space, apply, problem.precondition, delta, work, options);
  ActiveSetStep step;
  step.cg_iterations = solve.iterations;
  step.solved = solve.converged;
  if (solve.iterations > 0 && solve.residual > 0.0)
    step.cg_digits = std::log10(solve.first_residual / solve.residual);
  step.curvature = space.sum_all(apply(delta, work.image));
  return step;
}

void recover_multipliers(const Part& part, const Traces& traces, const ActiveSet& set,
                         std::span<double> residual, ContactState& state) {
  const TraceRows rows(part, set.held);
  // Forces at held rows are what is left once the slipping points have taken theirs.
  subtract_slip_force(traces, set, state.trace.tangential, residual);
  Vector force(rows.local());
  rows.lift_transpose(residual, force);
  std::size_t at = 0;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto& point = traces.points()[i];
    const double root = std::sqrt(point.mass);
    state.lambda.normal[i] = set.held[i].normal ? force[at++] / root : 0.0;
    state.phi.normal[i] = std::min(state.trace.normal[i], state.gap[i]);
    double* friction = &state.lambda.tangential[2 * i];
    const double* w = &state.trace.tangential[2 * i];
    const double* s = &set.slip_direction[2 * i];
    if (set.held[i].tangential) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
        friction[k] = force[at++] / root;
    } else if (point.tangents > 0) {
      const double along = w[0] * s[0] + w[1] * s[1];
      for (std::size_t k = 0; k < 2; ++k)
        friction[k] = set.slip_force[2 * i + k] + set.slip_stiffness[i] * (w[k] - along * s[k]);
      const double length = std::hypot(friction[0], friction[1]);
      if (length > state.bound[i])
        for (std::size_t k = 0; k < 2; ++k) friction[k] *= state.bound[i] / length;
    }
    for (std::size_t k = 0; k < 2; ++k) state.phi.tangential[2 * i + k] = set.held[i].tangential ? 0.0 : w[k];
  }
}

}  // namespace kacanov
