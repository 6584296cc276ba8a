// SPDX-License-Identifier: BSD-3-Clause
// From one share of the load to the next, and the history of what each came to.
#include "load_steps.hpp"

#include "collect.hpp"

namespace kacanov {
namespace {

/// The line in the middle of a run.
LoadStep line_now(const OuterLoop& loop, double share, const Result& result) {
  const StepContext& context = loop.context();
  Solution now;
  now.result = result;
  collect_contact(context.part, context.state, context.options.tolerance, now);
  collect_totals(context.part, context.state, now);
  now.result.certificate = context.certify().certificate;
  return load_step_line(now.result, share);
}

/// Whether the next load step has something to start from.
bool worth_going_on(const OuterLoop& loop, const Result& result) {
  if (!result.message.empty()) return false;
  const SolverOptions& options = loop.context().options;
  return options.stop == SolverOptions::Stop::paper ||
         loop.context().certify().certificate.exhausted(options.tolerance);
}

}  // namespace

bool run_load_steps(OuterLoop& loop, std::span<const double> shares, Result& result) {
  bool finished = loop.run(result);
  while (finished && result.load_steps.size() + 1 < shares.size() && worth_going_on(loop, result)) {
    const std::size_t over = result.load_steps.size();
    result.load_steps.push_back(line_now(loop, shares[over], result));
    loop.go_to(shares[over + 1], result);
    finished = loop.run(result);
  }
  return finished;
}

LoadStep load_step_line(const Result& result, double share) {
  LoadStep step;
  step.factor = share;
  step.outer_iterations = result.outer_iterations;
  step.cg_iterations = result.cg_iterations;
  for (const LoadStep& before : result.load_steps) {
    step.outer_iterations -= before.outer_iterations;
    step.cg_iterations -= before.cg_iterations;
  }
  step.active_nodes = result.active_nodes;
  step.slip_nodes = result.slip_nodes;
  step.contact_force = result.contact_force;
  step.friction_force = result.friction_force;
  step.max_contact_pressure = result.max_contact_pressure;
  step.plastic_elements = result.plastic_elements;
  step.worst_residual = result.certificate.worst();
  step.probe = result.probe;
  return step;
}

}  // namespace kacanov
