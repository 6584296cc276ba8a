// SPDX-License-Identifier: BSD-3-Clause
// One primal–dual active set (semismooth Newton) step for contact and friction.
#include "contact/active_set_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/active_constraints.hpp"
#include "contact/linearisation_error.hpp"
#include "linear/gcr.hpp"

namespace kacanov {
namespace {

/// With pressure-dependent friction, a solve first takes this many iterations with one multigrid cycle each
/// (200 random cases: 75 applications in the median; with inner solves from the start 97), ...
constexpr int direct_iterations = 15;
/// ... and then this many with inner solves of the symmetric part to this reduction: bodies that yield
/// everywhere need hundreds of CG iterations per solve.
constexpr int nested_iterations = 12;
constexpr double nested_reduction = 0.3;
/// Largest remaining share of the residual for a step that is still taken.
constexpr double worth_taking = 0.5;

/// Returns k (I − ŝŝᵀ) w of a slipping point: its resistance against turning of the slip direction.
std::array<double, 2> turning_force(const ActiveSet& set, std::size_t i, const double* w) {
  const double* s = &set.slip_direction[2 * i];
  const double along = w[0] * s[0] + w[1] * s[1];
  return {set.slip_stiffness[i] * (w[0] - along * s[0]), set.slip_stiffness[i] * (w[1] - along * s[1])};
}

/// Subtracts the force of the slipping points at the traces w: y −= Tᵀ M (ψŝ + k (I − ŝŝᵀ) w).
void subtract_slip_force(const Traces& traces, const ActiveSet& set, const Vector& tangential,
                         std::span<double> y) {
  ContactValues force(traces.size());
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto turning = turning_force(set, i, &tangential[2 * i]);
    for (std::size_t k = 0; k < 2; ++k) force.tangential[2 * i + k] = set.slip_force[2 * i + k] + turning[k];
  }
  traces.add_force(force, -1.0, y);
}

/// y += Tᵀ M k (I − ŝŝᵀ) T x. Returns this rank's share of the increase of xᵀ y.
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

/// Sets the smallest nodal displacement that closes the gaps and undoes the slip of held rows; returns the
/// largest of these gaps and slips.
double close_rows(const TraceRows& rows, const ActiveSet& set, const Traces& traces,
                  const ContactState& state, std::span<double> delta) {
  Vector closing(rows.local());
  std::size_t at = 0;
  double furthest = 0.0;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const ContactPoint& point = traces.points()[i];
    const double root = std::sqrt(point.mass);
    if (set.held[i].normal) closing[at++] = root * (state.gap[i] - state.trace.normal[i]);
    if (set.held[i].tangential)
      for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
        closing[at++] = -root * state.trace.tangential[2 * i + k];
  }
  for (const double v : closing) furthest = std::max(furthest, std::abs(v));
  rows.lift(closing, delta);
  return traces.ranks().max_all(furthest);
}

/// Computes the minimum-norm multipliers of held rows for nodal forces.
void least_reactions(const TraceRows& rows, const ActiveSet& set, const Traces& traces,
                     std::span<const double> residual, ContactValues& lambda) {
  Vector force(rows.local());
  rows.lift_transpose(residual, force);
  std::size_t at = 0;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const ContactPoint& point = traces.points()[i];
    const double root = std::sqrt(point.mass);
    if (set.held[i].normal) lambda.normal[i] = force[at++] / root;
    if (set.held[i].tangential)
      for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
        lambda.tangential[2 * i + k] = force[at++] / root;
  }
}

/// The symmetric problem of a step, with reactions along the held directions.
struct SymmetricPart {
  const Space& space;
  std::function<double(std::span<const double>, std::span<double>)> apply;
  const std::function<void(std::span<const double>, std::span<double>)>& precondition;
  /// The same, with a penalty that keeps it definite if all active points slide and nothing else holds the
  /// body.
  std::function<double(std::span<const double>, std::span<double>)> definite;
};

/// Replaces conjugate_gradients for a step with oblique reactions (theory: coulomb-newton): GCR, first with
/// one multigrid cycle per iteration, then with inner solves of the symmetric part.
CgResult solve_oblique(const SymmetricPart& part, const HeldNodes& nodes, std::span<double> delta,
                       CgWork& work, const CgOptions& options) {
  const Space& space = part.space;
  nodes.subtract_sliding(work.residual);
  space.project(work.residual);
  Vector residual = work.residual;
  CgResult result;
  result.first_residual = space.residual_norm(residual);
  const double target = options.target(result.first_residual);
  const auto oblique = [&](std::span<const double> p, std::span<double> q) {
    part.apply(p, q);
    nodes.subtract_sliding(q);
    space.project(q);
  };
  const auto cycle = [&](std::span<const double> r, std::span<double> z) {
    part.precondition(r, z);
    space.project(z);
    ++result.iterations;
    return true;
  };
  const auto symmetric = [&](std::span<const double> r, std::span<double> z) {
    std::copy(r.begin(), r.end(), work.residual.begin());
    const CgOptions inner{0.3 * target, nested_reduction, options.max_iterations};
    const CgResult found = conjugate_gradients(space, part.definite, part.precondition, z, work, inner);
    result.iterations += found.iterations;
    return found.converged;
  };
  GcrResult found = gcr(space, oblique, cycle, {delta, residual}, {target, direct_iterations});
  if (!found.converged)
    found = gcr(space, oblique, symmetric, {delta, residual}, {target, nested_iterations});
  result.residual = found.residual;
  result.converged = found.converged;
  return result;
}

}  // namespace

std::vector<NodeBlock> slip_blocks(const Part& part, const ActiveSet& set) {
  const std::size_t dim = part.dim();
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
                              const ContactState& state, CgOptions options, CgWork& work) {
  const Traces& traces = *problem.traces;
  const TraceRows rows(part, set.held);
  Space space(part);
  space.weigh(problem.space->weights());
  rows.hold_in(space);
  const HeldNodes nodes(part, set, state);
  ActiveSetStep step;
  Vector& delta = step.delta = Vector(part.unknowns());

  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    const double share = problem.apply(p, q);
    return share + add_slip_stiffness(traces, set, p, q);
  };
  const auto pull = [&](std::span<double> f) {
    problem.pull(f);
    subtract_slip_force(traces, set, state.trace.tangential, f);
  };
  pull(work.residual);
  // First close the held rows.
  const double wide = part.wide_contact ? close_rows(rows, set, traces, state, delta) : 0.0;
  step.closing = std::max(wide, nodes.close(delta));
  double closed = 0.0;
  if (step.closing > 0.0) {
    closed = space.sum_all(apply(delta, work.image));
    for (std::size_t i = 0; i < delta.size(); ++i) work.residual[i] -= work.image[i];
  }
  const SymmetricPart symmetric{
      space, apply, problem.precondition, [&](std::span<const double> p, std::span<double> q) {
        const double share = apply(p, q);
        return problem.loose > 0.0 ? share + traces.add_penalty({0.0, problem.loose}, p, q) : share;
      }};
  if (problem.unbalanced)
    options.left_out = [&] {
      return left_out(problem, space, state, delta, work, [&](const ContactValues& trace, Vector& f) {
        subtract_slip_force(traces, set, trace.tangential, f);
      });
    };
  const CgResult solve = nodes.oblique()
                             ? solve_oblique(symmetric, nodes, delta, work, options)
                             : conjugate_gradients(space, apply, problem.precondition, delta, work, options);
  step.cg_iterations = solve.iterations;
  step.met = solve.converged;
  step.solved = solve.converged || (nodes.oblique() && solve.residual < worth_taking * solve.first_residual);
  if (solve.iterations > 0 && solve.residual > 0.0)
    step.cg_digits = std::log10(solve.first_residual / solve.residual);
  step.turning = space.sum_all(add_slip_stiffness(traces, set, delta, work.image));
  if (nodes.oblique()) {
    step.curvature = space.sum_all(apply(delta, work.image));
    nodes.subtract_sliding(work.image);
    step.slope = space.dot(delta, work.image);
    return step;
  }
  step.curvature = solve.energy;
  if (step.closing > 0.0) {
    // δ = c + x, c the closing displacement and x the CG solution, which lies in the space and satisfies xᵀ(f
    // − B c) = xᵀB x.
    pull(work.image);
    space.project(work.image);
    step.curvature += closed + 2.0 * (space.dot(delta, work.image) - solve.energy);
  }
  step.slope = step.curvature;
  return step;
}

void recover_multipliers(const Part& part, const Traces& traces, const ActiveSet& set,
                         std::span<double> residual, ContactState& state) {
  const HeldNodes nodes(part, set, state);
  // Forces at held rows are the remainder after those of slipping points.
  subtract_slip_force(traces, set, state.trace.tangential, residual);
  std::fill(state.lambda.normal.begin(), state.lambda.normal.end(), 0.0);
  std::fill(state.lambda.tangential.begin(), state.lambda.tangential.end(), 0.0);
  if (part.wide_contact) least_reactions(TraceRows(part, set.held), set, traces, residual, state.lambda);
  nodes.reactions(residual, state.lambda);
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto& point = traces.points()[i];
    state.phi.normal[i] = std::min(state.trace.normal[i], state.gap[i]);
    double* friction = &state.lambda.tangential[2 * i];
    const double* w = &state.trace.tangential[2 * i];
    const double* s = &set.slip_direction[2 * i];
    if (!set.held[i].tangential && point.tangents > 0) {
      const double along = w[0] * s[0] + w[1] * s[1];
      const double pressure = std::max(state.lambda.normal[i], 0.0);
      for (std::size_t k = 0; k < 2; ++k)
        friction[k] = set.slip_force[2 * i + k] + set.coulomb[i] * pressure * s[k] +
                      set.slip_stiffness[i] * (w[k] - along * s[k]);
      const double length = std::hypot(friction[0], friction[1]);
      const double bound = set.coulomb[i] > 0.0
                               ? point.friction_bound(pressure)
                               : std::hypot(set.slip_force[2 * i], set.slip_force[2 * i + 1]);
      if (length > bound)
        for (std::size_t k = 0; k < 2; ++k) friction[k] *= bound / length;
    }
    for (std::size_t k = 0; k < 2; ++k) state.phi.tangential[2 * i + k] = set.held[i].tangential ? 0.0 : w[k];
  }
}

}  // namespace kacanov
