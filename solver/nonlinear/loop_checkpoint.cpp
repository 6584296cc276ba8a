// SPDX-License-Identifier: BSD-3-Clause
// The outer loop's state on its way into a checkpoint and out of it.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
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
  entry("load_reached", result.load_reached);
  entry("load_cuts", result.load_cuts);
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

/// The numbers of load steps in a row, and back.
Vector history(std::vector<LoadStep> steps) {
  Vector all;
  for (LoadStep& step : steps)
    visit_load_step(step, [&](auto& value) { all.push_back(static_cast<double>(value)); });
  return all;
}

void set_history(std::vector<LoadStep>& steps, const Vector& all) {
  auto next = all.begin();
  for (LoadStep& step : steps)
    visit_load_step(
        step, [&](auto& value) { value = static_cast<std::remove_reference_t<decltype(value)>>(*next++); });
}

/// What of a checkpoint has a unit; the history of load steps is in the user's as it is.
void scale(Checkpoint& checkpoint, const UnitSystem& factors) {
  for (const char* name : {"r_star", "r_active", "penalty_normal", "penalty_tangential"})
    if (const auto found = checkpoint.numbers.find(name); found != checkpoint.numbers.end())
      found->second *= factors.penalty();
  for (const char* name : {"lambda_min", "lambda_max"})
    if (const auto found = checkpoint.numbers.find(name); found != checkpoint.numbers.end())
      found->second /= factors.penalty();
  for (auto& [name, values] : checkpoint.fields) {
    const double factor = name == "load_steps" ? 1.0
                          : name == "r"        ? factors.penalty()
                          : name == "pressure" || name == "friction" || name == "bound"
                              ? factors.stress()
                              : factors.displacement;
    for (double& value : values) value *= factor;
  }
}

}  // namespace

bool OuterLoop::stop_agreed() const {
  return context_.part.node_map.any(run_.stop_requested && run_.stop_requested());
}

void OuterLoop::keep(const Result& result) {
  if (stoppable_) {
    kept_ = Kept{context_.state, control_, result};
    if (stop_agreed()) throw Interrupted{};
  }
  if (result.outer_iterations == 0) return;
  const double before = MPI_Wtime();
  const Communicator& ranks = context_.part.node_map;
  const bool due = ranks.rank == 0 && run_.checkpoint && (!run_.checkpoint_due || run_.checkpoint_due());
  if (!ranks.any(due)) return;
  const Checkpoint all = checkpoint(result);
  if (due) run_.checkpoint(all);
  checkpoint_seconds_ += MPI_Wtime() - before;
}

bool OuterLoop::run(Result& result) {
  try {
    iterate(result);
  } catch (const Interrupted&) {
    context_.state = kept_->state;
    control_ = kept_->control;
    result = kept_->result;
    return false;
  }
  return true;
}

Checkpoint OuterLoop::checkpoint(const Result& result) const {
  const Part& part = context_.part;
  const ContactState& state = context_.state;
  Checkpoint out;
  const auto put = [&](const char* name, const auto& value) {
    out.numbers[name] = static_cast<double>(value);
  };
  visit_counts(result, put);
  Control control = control_;
  control.fallback.visit(put);
  control.linearisation.visit(put);
  put("first_outer", first_outer_);
  put("operator_applications", applications());
  put("penalty_rule", options_.penalty);
  put("penalty_normal", control.penalty.value().normal);
  put("penalty_tangential", control.penalty.value().tangential);
  put("load_steps_over", result.load_steps.size());
  out.fields["r"] = result.r;
  out.fields["load_steps"] = history(result.load_steps);
  out.fields["displacement"] = gather_nodal(part, state.u, part.dim());
  out.fields["pressure"] = gather_contact(part, state.lambda.normal, 1);
  out.fields["friction"] = gather_contact(part, state.lambda.tangential, 2);
  out.fields["phi_normal"] = gather_contact(part, state.phi.normal, 1);
  out.fields["phi_tangential"] = gather_contact(part, state.phi.tangential, 2);
  out.fields["bound"] = gather_contact(part, state.bound, 1);
  if (history_) {
    Vector origin = state.origin;
    origin.resize(2 * state.bound.size(), 0.0);
    out.fields["slip_origin"] = gather_contact(part, origin, 2);
  }
  scale(out, units_);
  return out;
}

void OuterLoop::restore(const Checkpoint* users, Result& result) {
  const Part& part = context_.part;
  const bool here = part.node_map.rank == 0;
  Checkpoint own;
  if (here) {
    own = *users;
    scale(own, units_.inverse());
  }
  const Checkpoint* from = &own;
  const auto get = [&](const char* name, auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    // Counts beyond what the others hold could not be added to.
    constexpr std::int64_t most = std::int64_t{1} << (sizeof(Value) == 4 ? 30 : 50);
    double number = 0.0;
    if (here)
      number = std::is_integral_v<Value> ? static_cast<double>(from->count(name, most)) : from->number(name);
    part.node_map.expect_all_here();
    if (part.node_map.ranks > 1) MPI_Bcast(&number, 1, MPI_DOUBLE, 0, mpi_of(part.node_map));
    value = static_cast<Value>(number);
  };
  const auto values = [&](const char* name, std::size_t entries) {
    Vector all(entries);
    if (here) all = from->field(name, entries);
    part.node_map.expect_all_here(CallSite(), static_cast<std::int64_t>(entries));
    if (part.node_map.ranks > 1)
      MPI_Bcast(all.data(), static_cast<int>(entries), MPI_DOUBLE, 0, mpi_of(part.node_map));
    return all;
  };
  visit_counts(result, get);
  control_.fallback.visit(get);
  control_.linearisation.visit(get);
  get("operator_applications", earlier_applications_);
  Penalty penalty;
  get("penalty_normal", penalty.normal);
  get("penalty_tangential", penalty.tangential);
  // A penalty that another rule has chosen, or the user, is none to go on with.
  double rule = 0.0;
  get("penalty_rule", rule);
  if (options_.penalty == SolverOptions::Penalty::fixed || rule != static_cast<double>(options_.penalty))
    penalty = {};
  control_.penalty.restore(penalty, result.lambda_min);
  result.restarted_after = result.outer_iterations;
  opening_ = result.outer_iterations == 0;
  first_outer_ = result.outer_iterations;  // who asks for a restart asks for more steps
  std::size_t steps = 0;
  get("load_steps_over", steps);
  result.load_steps.resize(steps);
  for (LoadStep& step : result.load_steps) step.probe.resize(part.total_probes);
  set_history(result.load_steps, values("load_steps", history(result.load_steps).size()));
  result.r = values("r", result.outer_iterations);

  const auto finite = [&](const char* name, std::size_t entries) {
    if (!here) return Vector();
    const Vector& field = from->field(name, entries);
    if (!std::all_of(field.begin(), field.end(), [](double v) { return std::isfinite(v); }))
      throw InputError(std::string("the checkpoint's field \"") + name +
                       "\" has an entry that is not finite");
    return field;
  };
  const std::size_t points = part.total_contact;
  const auto contact = [&](const char* name, int components) {
    return scatter_contact(part, finite(name, points * static_cast<std::size_t>(components)), components);
  };
  const auto unknowns = static_cast<std::size_t>(part.total_nodes()) * static_cast<std::size_t>(part.dim());
  ContactState& state = context_.state;
  state.u = scatter_nodal(part, finite("displacement", unknowns), part.dim());
  state.lambda.normal = contact("pressure", 1);
  state.lambda.tangential = contact("friction", 2);
  state.phi.normal = contact("phi_normal", 1);
  state.phi.tangential = contact("phi_tangential", 2);
  state.bound = contact("bound", 1);
  if (history_) state.origin = contact("slip_origin", 2);
  state.evaluate(context_.traces);
  context_.preconditioner.mark_stale();
}

}  // namespace kacanov
