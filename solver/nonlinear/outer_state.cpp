// SPDX-License-Identifier: BSD-3-Clause
// The outer loop's state on its way into a checkpoint and out of it.
#include <algorithm>
#include <vector>

#include "nonlinear/outer_loop.hpp"

namespace kacanov {
namespace {

/// The counts of a result that go on after a restart.
template <class R, class Visitor>
void visit_counts(R& result, Visitor&& entry) {
  entry("outer_iterations", result.outer_iterations);
  entry("contact_iterations", result.contact_iterations);
  entry("cg_iterations", result.cg_iterations);
  entry("operator_applications", result.operator_applications);
  entry("spectrum_applications", result.spectrum_applications);
  entry("contact_applications", result.contact_applications);
  entry("lambda_min", result.lambda_min);
  entry("lambda_max", result.lambda_max);
  entry("r_star", result.r_star);
  entry("r_active", result.r_active);
}

template <class Visitor>
void visit_load_step(LoadStep& step, Visitor&& entry) {
  entry(step.factor);
  entry(step.outer_iterations);
  entry(step.cg_iterations);
  entry(step.active_nodes);
  entry(step.slip_nodes);
  entry(step.max_contact_pressure);
  entry(step.plastic_elements);
  entry(step.worst_residual);
  for (double& value : step.contact_force) entry(value);
  for (double& value : step.friction_force) entry(value);
  for (Vector3& probe : step.probe)
    for (double& value : probe) entry(value);
}

}  // namespace

bool OuterLoop::stop_agreed() const { return part_.halo.any(run_.stop_requested && run_.stop_requested()); }

void OuterLoop::keep(const Result& result) {
  if (run_.stop_requested) {
    kept_ = {state_, loop_, penalty_, newton_failed_, result};
    if (stop_agreed()) throw Interrupted{};
  }
  if (result.outer_iterations == 0) return;
  const double before = MPI_Wtime();
  const bool due = part_.halo.rank == 0 && run_.checkpoint && (!run_.checkpoint_due || run_.checkpoint_due());
  if (!part_.halo.any(due)) return;
  const Checkpoint all = checkpoint(result);
  if (due) run_.checkpoint(all);
  checkpoint_seconds_ += MPI_Wtime() - before;
}

bool OuterLoop::run(Result& result) {
  try {
    iterate(result);
  } catch (const Interrupted&) {
    state_ = kept_.state;
    loop_ = kept_.loop;
    penalty_ = kept_.penalty;
    newton_failed_ = kept_.newton_failed;
    result = kept_.result;
    return false;
  }
  return true;
}

void OuterLoop::scale(double ratio, const Result& result) {
  take_gaps();
  for (double& u : state_.omega) u *= ratio;
  part_.prescribe(state_.omega);
  for (Vector* v : {&state_.lambda.normal, &state_.lambda.tangential, &state_.phi.tangential})
    for (double& value : *v) value *= ratio;
  traces_.evaluate(state_.omega, state_.trace);
  for (std::size_t i = 0; i < part_.contact.size(); ++i)
    state_.phi.normal[i] = std::min(state_.trace.normal[i], state_.gap[i]);
  update_bounds();
  loop_ = {};
  loop_.first_outer = result.outer_iterations;
}

Checkpoint OuterLoop::checkpoint(const Result& result) const {
  Checkpoint out;
  const auto put = [&](const char* name, const auto& value) {
    out.numbers[name] = static_cast<double>(value);
  };
  visit_counts(result, put);
  LoopState loop = loop_;
  loop.visit(put);
  put("operator_applications", applications());
  put("penalty_rule", options_.penalty);
  put("penalty_normal", penalty_.normal);
  put("penalty_tangential", penalty_.tangential);
  put("load_steps_over", result.load_steps.size());
  put("newton_failed", newton_failed_);
  out.fields["r"] = result.r;
  out.fields["load_steps"] = {};
  for (LoadStep step : result.load_steps) {
    visit_load_step(step,
                    [&](auto& value) { out.fields["load_steps"].push_back(static_cast<double>(value)); });
  }
  out.fields["displacement"] = gather_nodal(part_, state_.omega, part_.dim());
  out.fields["pressure"] = gather_contact(part_, state_.lambda.normal, 1);
  out.fields["friction"] = gather_contact(part_, state_.lambda.tangential, 2);
  out.fields["phi_normal"] = gather_contact(part_, state_.phi.normal, 1);
  out.fields["phi_tangential"] = gather_contact(part_, state_.phi.tangential, 2);
  out.fields["bound"] = gather_contact(part_, state_.bound, 1);
  return out;
}

void OuterLoop::restore(const Checkpoint* from, Result& result) {
  const bool here = part_.halo.rank == 0;
  const auto get = [&](const char* name, auto& value) {
    double number = here ? from->number(name) : 0.0;
    if (part_.halo.ranks > 1) MPI_Bcast(&number, 1, MPI_DOUBLE, 0, part_.halo.comm);
    value = static_cast<std::remove_reference_t<decltype(value)>>(number);
  };
  visit_counts(result, get);
  loop_.visit(get);
  get("operator_applications", earlier_applications_);
  get("penalty_normal", penalty_.normal);
  get("penalty_tangential", penalty_.tangential);
  get("newton_failed", newton_failed_);
  // A penalty that another rule has chosen, or the user, is none to go on with.
  double rule = 0.0;
  get("penalty_rule", rule);
  if (options_.penalty == SolverOptions::Penalty::fixed || rule != static_cast<double>(options_.penalty))
    penalty_ = {};
  result.restarted_after = result.outer_iterations;
  loop_.first_outer = result.outer_iterations;  // who asks for a restart asks for more steps
  double steps = 0.0;
  get("load_steps_over", steps);
  result.load_steps.resize(static_cast<std::size_t>(steps));
  std::size_t entries = 0;
  for (LoadStep& step : result.load_steps) {
    step.probe.resize(static_cast<std::size_t>(part_.total_probes));
    visit_load_step(step, [&](auto&) { ++entries; });
  }
  Vector history(entries);
  if (here) history = from->field("load_steps", entries);
  if (part_.halo.ranks > 1)
    MPI_Bcast(history.data(), static_cast<int>(entries), MPI_DOUBLE, 0, part_.halo.comm);
  auto next = history.begin();
  for (LoadStep& step : result.load_steps) {
    visit_load_step(
        step, [&](auto& value) { value = static_cast<std::remove_reference_t<decltype(value)>>(*next++); });
  }
  result.r.resize(static_cast<std::size_t>(result.outer_iterations));
  if (here) result.r = from->field("r", result.r.size());
  if (part_.halo.ranks > 1)
    MPI_Bcast(result.r.data(), static_cast<int>(result.r.size()), MPI_DOUBLE, 0, part_.halo.comm);

  const auto points = static_cast<std::size_t>(part_.total_contact);
  const auto contact = [&](const char* name, int components) {
    const auto width = static_cast<std::size_t>(components);
    return scatter_contact(part_, here ? from->field(name, points * width) : Vector(), components);
  };
  const auto unknowns = static_cast<std::size_t>(part_.total_nodes) * static_cast<std::size_t>(part_.dim());
  state_.omega = scatter_nodal(part_, here ? from->field("displacement", unknowns) : Vector(), part_.dim());
  state_.lambda.normal = contact("pressure", 1);
  state_.lambda.tangential = contact("friction", 2);
  state_.phi.normal = contact("phi_normal", 1);
  state_.phi.tangential = contact("phi_tangential", 2);
  state_.bound = contact("bound", 1);
  traces_.evaluate(state_.omega, state_.trace);
  preconditioner_stale_ = true;
}

}  // namespace kacanov
