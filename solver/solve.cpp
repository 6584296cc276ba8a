// SPDX-License-Identifier: BSD-3-Clause
// The solver's main entry point: runs the loops, certifies the solution and collects the result.
#include <kacanov/part.hpp>
#include <kacanov/solve.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "amg/make_preconditioner.hpp"
#include "linear/reference_response.hpp"
#include "linear/springs.hpp"
#include "mesh/classic_locale_stream.hpp"
#include "nonlinear/convergence_diagnosis.hpp"
#include "nonlinear/friction_bounds.hpp"
#include "nonlinear/load_steps.hpp"
#include "partition/nondimensionalisation.hpp"
#include "results/collect.hpp"
#include "results/reactions.hpp"
#include "spectrum/spectrum.hpp"

namespace kacanov {
namespace {

/// Returns the number of load steps, of `steps`, that the run to continue has completed, on all ranks.
std::size_t steps_over(const Part& part, const RunOptions& run, std::size_t steps) {
  const bool here = part.node_map.rank == 0 && run.start != nullptr;
  const auto most = static_cast<std::int64_t>(steps) - 1;
  return static_cast<std::size_t>(
      part.node_map.max_all(here ? static_cast<double>(run.start->count("load_steps_over", most)) : 0.0));
}

void begin(const Part& part, const RunOptions& run, const char* phase) {
  if (run.phase && part.node_map.rank == 0) run.phase(phase);
}

/// Returns the successive shares of the load, or with load curves the times of their points.
std::vector<double> load_points(const Part& part, const SolverOptions& options) {
  if (part.steps.empty()) return options.load_steps.empty() ? std::vector{1.0} : options.load_steps;
  std::vector<double> times;
  for (std::size_t i = 1; i < part.steps.size(); ++i) times.push_back(part.steps[i].time);
  return times;
}

/// R(u) and stored energy by the reference operator, so that the certificate does not depend on the operator
/// of the loop.
struct Response {
  Vector internal;
  double energy = 0.0;
};

/// Collective. `dilatation`: corner_dilatation() of the state.
Response respond_independently(const StepContext& context, std::span<const double> dilatation) {
  const Part& part = context.part;
  const Vector& u = context.state.u;
  const Vector strain = context.body.linear() ? Vector() : context.free_strain;
  Response response{Vector(part.unknowns())};
  response.energy =
      reference_response(part, {u, strain, dilatation}, response.internal) + spring_energy(part, u);
  response.energy = part.node_map.sum_all(response.energy);
  part.node_map.sum(response.internal, part.dim());
  add_spring_response(part, u, response.internal);
  return response;
}

/// Returns the status. If the loop made no further progress (`gave_up`) and rounding errors exceed the
/// tolerance, they are the reason.
Status status_of(const Certificate& certificate, double tolerance, bool gave_up) {
  const double unknown = certificate.rounding.worst();
  if (certificate.meets(tolerance)) return Status::converged;
  if (certificate.exhausted(tolerance)) return Status::limited_by_rounding;
  return gave_up && unknown > tolerance && std::isfinite(unknown) ? Status::limited_by_rounding
                                                                  : Status::not_converged;
}

std::string verdict(const Result& result, const SolverOptions& options) {
  PlainText text;
  text.precision(2);
  text << std::scientific;
  const double worst = result.certificate.worst();
  if (result.status == Status::converged) {
    text << "all KKT residuals are at most " << worst << " (tolerance " << options.tolerance << ")";
  } else if (result.status == Status::limited_by_rounding) {
    const double unknown = result.certificate.rounding.worst();
    text << "the KKT residuals, at most " << worst << ", can be known to " << unknown << " only, "
         << (unknown > options.tolerance ? "which is above" : "too much beside") << " the tolerance "
         << options.tolerance
         << ": parts far stiffer than others, or a body that moves far and strains little, leave no more";
    if (!result.certificate.exhausted(options.tolerance))
      text << "; and nothing better than these residuals was found: the numbers are no solution";
  } else if (result.status == Status::interrupted) {
    text << "interrupted after " << result.outer_iterations << " outer steps, with the worst KKT residual at "
         << worst;
  } else if (options.stop == SolverOptions::Stop::paper) {
    text << "stopped by the size of its step with tolerance " << options.tolerance
         << ", but the worst KKT residual is " << worst << ": the step was small, the error is not";
  } else {
    text << "after " << result.outer_iterations << " outer steps the worst KKT residual is " << worst
         << ", above the tolerance " << options.tolerance;
    if (result.bound_change > options.tolerance)
      text << "; Coulomb's bound still moves by " << result.bound_change << " of the pressure a step";
  }
  return text.str();
}

/// Adds the line of the last load step, and names the load step at which an incomplete run stopped.
void end_load_steps(const std::vector<double>& shares, bool finished, Result& result) {
  const std::size_t over = result.load_steps.size();
  if (finished) result.load_steps.push_back(load_step_line(result, shares[over]));
  if (over + 1 == shares.size() && finished) return;
  result.message = load_step_name(over, shares.size(), result.by_time, shares[over]) + ": " + result.message;
}

/// Passes the state at the end of a load step to the caller.
void hand_out_step(const StepContext& context, const Result& result, const RunOptions& run,
                   Nondimensionalised& scaled) {
  Solution now;
  now.displacement = context.state.u;
  now.thermal = context.path.thermal_pressure();
  now.corner_dilatation = corner_dilatation(context.part, context.state.u);
  collect_contact(context.part, context.state, context.options.tolerance, now);
  redimensionalise(now, scaled.units());
  now.result.load_steps = result.load_steps;
  now.result.by_time = result.by_time;
  now.result.load_factor = context.path.share();
  const Redimensionalised back(scaled);
  run.load_step_over(context.part, now);
}

std::string unsolved_message(const Result& result, const SolverOptions& options) {
  return "the linear solves of " + std::to_string(result.unsolved_steps) + " of " +
         std::to_string(result.outer_iterations) +
         " outer steps did not converge: more than solver.max_cg = " + std::to_string(options.max_cg) +
         " iterations, or no definite operator";
}

std::string softening_message(std::int64_t elements) {
  return "; " + std::to_string(elements) +
         " elements are in the softening range of their law (squared argument), where the problem is not "
         "monotone";
}

}  // namespace

Solution solve(Part& part, const SolverOptions& users_options, const RunOptions& run) {
  validate(users_options);
  const double began = MPI_Wtime();
  const bool restart = part.node_map.any(part.node_map.rank == 0 && run.start != nullptr);
  std::optional<Start> start;
  if (!restart && !run.coarse.empty() && !run.coarse[0].at_rest()) start = interpolate(run.coarse[0], part);
  if (!restart && run.from != nullptr) start = *run.from;
  Nondimensionalised scaled(part);
  if (start) nondimensionalise(*start, scaled.units());
  SolverOptions options = users_options;
  options.r /= scaled.units().penalty();
  Solution solution;
  Result& result = solution.result;
  const std::vector<double> shares = load_points(part, options);
  begin(part, run, "setting the solver up");
  result.by_time = !part.steps.empty();
  OuterLoop loop(part, options, run, shares[steps_over(part, run, shares.size())]);
  loop.work_in(scaled.units());
  const StepContext& context = loop.context();
  if (start) loop.adopt(*start);
  const double prepared = MPI_Wtime();
  if (restart) loop.restore(run.start, result);
  result.message = part.no_equilibrium;
  begin(part, run, "solving");
  FreeMotions free_motions;
  const auto look = [&](const std::string& place) {
    const Redimensionalised back(scaled);
    free_motions.look(part, context.state, options.tolerance, place);
  };
  LoadStepCalls calls;
  calls.begins = [&](std::size_t step) {
    if (run.stage && shares.size() > 1 && part.node_map.rank == 0)
      run.stage(load_step_name(step, shares.size(), result.by_time, shares[step]));
  };
  calls.over = [&] {
    if (run.load_step_over) hand_out_step(context, result, run, scaled);
    const std::size_t over = result.load_steps.size();
    look(load_step_name(over - 1, shares.size(), result.by_time, shares[over - 1]));
  };
  if (shares.size() > 1 && run.coarse.size() == shares.size())
    calls.coarse = [&](std::size_t step) {
      Start at;
      {
        const Redimensionalised back(scaled);
        at = interpolate(run.coarse[step], part);
      }
      nondimensionalise(at, scaled.units());
      return at;
    };
  const bool finished = !part.no_equilibrium.empty() || run_load_steps(loop, shares, result, calls);
  const double looped = MPI_Wtime();

  solution.corner_dilatation = corner_dilatation(part, context.state.u);
  const Response response = respond_independently(context, solution.corner_dilatation);
  result.certificate =
      context.certify(response.internal, response.energy, solution.corner_dilatation).certificate;
  result.status = status_of(result.certificate, options.tolerance, loop.gave_up() && !loop.ran_away());
  if (result.status == Status::limited_by_rounding && !result.certificate.exhausted(options.tolerance) &&
      result.cg_iterations > 0)
    result.message.clear();  // the load step is not the cause
  result.load_factor = context.path.share();
  if (!part.no_equilibrium.empty()) result.status = Status::not_converged;
  if (context.path.share() != shares.back()) result.status = Status::not_converged;
  if (loop.gave_up() && loop.ran_away()) result.status = Status::not_converged;
  if (!finished) result.status = Status::interrupted;
  // An unconverged run can be continued with more steps; a breakdown cannot.
  const bool wanted = part.node_map.any(part.node_map.rank == 0 && run.checkpoint);
  if (wanted && part.no_equilibrium.empty() && result.status != Status::converged &&
      std::isfinite(result.certificate.worst())) {
    const Checkpoint all = loop.checkpoint(result);
    if (part.node_map.rank == 0) run.checkpoint(all);
  }

  solution.displacement = context.state.u;
  solution.thermal = context.path.thermal_pressure();
  collect_contact(part, context.state, options.tolerance, solution);
  collect_totals(part, context.state, solution);
  collect_entries(part, context.state, context.path, response.internal, solution);
  redimensionalise(solution, scaled.units());
  if (result.message.empty()) {
    result.message = verdict(result, options);
    if (result.status == Status::not_converged && options.stop != SolverOptions::Stop::paper)
      result.message += "; " + diagnose_convergence(loop);
  }
  if (shares.size() > 1 || result.by_time) end_load_steps(shares, finished, result);
  if (result.softening_elements > 0) result.message += softening_message(result.softening_elements);
  if (result.status == Status::converged) look("");
  for (const std::string& warning : free_motions.warnings()) result.warnings.push_back(warning);
  if (result.unsolved_steps > 0) result.warnings.push_back(unsolved_message(result, options));
  result.unknowns = part.total_nodes() * part.dim();
  result.elements = part.total_elements;
  result.contact_nodes = part.total_contact;
  result.operator_applications = loop.applications();
  result.ranks = part.node_map.ranks;
  result.threads = run.threads;
  result.instruction_set = context.body.op().local().instruction_set();
  PhaseSeconds& seconds = result.seconds;
  const double end = MPI_Wtime();
  seconds.total = end - began;
  seconds.prepare = prepared - began;
  seconds.spectrum = loop.spectrum_seconds();
  seconds.preconditioner_setup = context.preconditioner.setup_seconds();
  seconds.checkpoint = loop.checkpoint_seconds();
  seconds.solve = looped - prepared - seconds.spectrum - seconds.checkpoint;
  seconds.certificate = end - looped;
  return solution;
}

Solution solve(const Part& part, const SolverOptions& options, const RunOptions& run) {
  Part own = part;
  return solve(own, options, run);
}

std::vector<SpectrumResult> analyse_spectrum(Part& part, const SolverOptions& options,
                                             const RunOptions& run) {
  validate(options);
  const Nondimensionalised scaled(part);
  DistributedOperator op(part, run.threads, run.instruction_set);
  const auto amg = make_preconditioner(options, part, run.threads, run.instruction_set, &op.local());
  std::vector<double> secant(part.body().secant_count());
  op.local().secant(secant);
  std::vector<SpectrumResult> results;
  if (part.total_contact == 0) return results;
  results.push_back(
      estimate_spectrum(part, op, *amg, secant, false, {options.spectrum_tolerance, options.max_cg}));
  if (has_friction(part))
    results.push_back(
        estimate_spectrum(part, op, *amg, secant, true, {options.spectrum_tolerance, options.max_cg}));
  for (SpectrumResult& result : results) redimensionalise(result, scaled.units());
  return results;
}

std::vector<SpectrumResult> analyse_spectrum(const Part& part, const SolverOptions& options,
                                             const RunOptions& run) {
  Part own = part;
  return analyse_spectrum(own, options, run);
}

ActivePenalty active_penalty(Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run) {
  validate(options);
  const Nondimensionalised scaled(part);
  std::vector<double> displacement = solution.displacement;
  for (double& u : displacement) u /= scaled.units().displacement;
  std::vector<double> pressure = solution.thermal;
  for (double& p : pressure) p /= scaled.units().stress();
  DistributedOperator op(part, run.threads, run.instruction_set);
  op.set_free_strain(free_strain(part, pressure));
  op.update(displacement);
  const auto amg = make_preconditioner(options, part, run.threads, run.instruction_set, &op.local());
  std::vector<double> secant(part.body().secant_count());
  op.local().secant(secant);
  std::vector<TraceChoice> active(part.contact.size()), open(part.contact.size());
  for (std::size_t i = 0; i < active.size(); ++i) {
    active[i] = {solution.pressure[i] > 0.0, solution.contact_status[i] == ContactStatus::stick};
    open[i] = {!active[i].normal, !active[i].tangential};
  }
  const TraceRows held(part, active), free(part, open);
  if (held.total() == 0) return {};
  Spectrum spectrum(part, op, *amg, secant, {options.spectrum_tolerance, options.max_cg});
  const double low = spectrum.smallest(held).value;
  if (!(low > 0.0)) return {0.0, spectrum.cost().converged};
  const double high =
      free.total() > 0 ? spectrum.largest(free, held, 0.01 / low, part.loose_modes > 0).value : 0.0;
  return {scaled.units().penalty() / std::sqrt(low * (high > 0.0 ? high : low)), spectrum.cost().converged};
}

ActivePenalty active_penalty(const Part& part, const Solution& solution, const SolverOptions& options,
                             const RunOptions& run) {
  Part own = part;
  return active_penalty(own, solution, options, run);
}

}  // namespace kacanov
