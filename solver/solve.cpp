// SPDX-License-Identifier: BSD-3-Clause
// The solver's front door: runs the loops, then certifies and collects the result.
#include <kacanov/solve.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include <kacanov/element_fields.hpp>
#include "contact/certificate.hpp"
#include "nonlinear/load_path.hpp"
#include "nonlinear/outer_loop.hpp"

namespace kacanov {
namespace {

/// Peak resident memory of this process, from the kernel's VmHWM.
std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (word == "VmHWM:") {
      std::uint64_t kib = 0;
      status >> kib;
      return kib * 1024;
    }
  return 0;
}

/// Fields of the contact points. `least_slip`: a tangential displacement beyond it is slip, whatever rounding
/// says of the bound.
void collect_contact(const Part& part, const ContactState& state, double least_slip, Solution& solution) {
  const auto points = std::span(part.contact);
  for (std::size_t i = 0; i < points.size(); ++i) {
    solution.gap.push_back(state.gap[i] - state.trace.normal[i]);
    solution.pressure.push_back(state.lambda.normal[i]);
    const double* friction = &state.lambda.tangential[2 * i];
    Vector3 traction{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(points[i].tangents); ++k)
      for (std::size_t c = 0; c < 3; ++c) traction[c] -= friction[k] * points[i].tangent[k][c];
    solution.traction.push_back(traction);
    // The projection leaves |λ_f| = ψ to rounding where it slips; Coulomb's ψ has moved on since by what the
    // solver tolerates.
    const double* slip = &state.trace.tangential[2 * i];
    const bool slips = points[i].tangents == 0 ||
                       std::hypot(friction[0], friction[1]) >= state.bound[i] * (1.0 - 1e-10) ||
                       std::hypot(slip[0], slip[1]) > least_slip;
    const bool touches = state.lambda.normal[i] > 0.0;
    solution.contact_status.push_back(!touches && points[i].tangents == 0 ? ContactStatus::open
                                      : slips                             ? ContactStatus::slip
                                                                          : ContactStatus::stick);
    if (!touches && points[i].tangents > 0 && state.bound[i] == 0.0)
      solution.contact_status.back() = ContactStatus::open;
  }
}

void collect_totals(const Part& part, const ContactState& state, const Solution& solution, Result& result) {
  const auto dim = static_cast<std::size_t>(part.dim());
  std::array<double, 9> sums{};  // contact force, friction force, active, slip, plastic
  double pressure = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i) {
    const auto& point = part.contact[i];
    for (std::size_t c = 0; c < 3; ++c) {
      sums[c] -= point.mass * state.lambda.normal[i] * point.trace[c];
      sums[3 + c] += point.mass * solution.traction[i][c];
    }
    sums[6] += state.lambda.normal[i] > 0.0 ? 1.0 : 0.0;
    sums[7] += point.tangents > 0 && solution.contact_status[i] == ContactStatus::slip ? 1.0 : 0.0;
    pressure = std::max(pressure, state.lambda.normal[i]);
  }
  double von_mises = 0.0;
  std::int64_t softening = 0;
  const Body body = part.body();
  visit_element_fields(part, state.omega, [&](const ElementRun& run) {
    for (const std::uint8_t p : run.plastic) sums[8] += p;
    for (const double v : run.von_mises) von_mises = std::max(von_mises, v);
    for (std::size_t e = 0; e < run.dev_strain.size(); ++e)
      softening += body.law(run.first + e).softens(run.dev_strain[e]) ? 1 : 0;
  });
  part.halo.sum_all(sums);
  for (std::size_t c = 0; c < 3; ++c) {
    result.contact_force[c] = sums[c];
    result.friction_force[c] = sums[3 + c];
  }
  result.active_nodes = std::llround(sums[6]);
  result.slip_nodes = std::llround(sums[7]);
  result.plastic_elements = std::llround(sums[8]);
  result.max_contact_pressure = part.halo.max_all(pressure);
  result.max_von_mises = part.halo.max_all(von_mises);
  result.softening_elements = part.halo.sum_all(softening);

  std::vector<double> probes(3 * static_cast<std::size_t>(part.total_probes), 0.0);
  const auto npe = static_cast<std::size_t>(nodes_per_element(part.type));
  for (std::size_t i = 0; i < part.probes.size(); ++i)
    for (std::size_t a = 0; a < npe; ++a) {
      const auto node =
          static_cast<std::size_t>(part.elements[static_cast<std::size_t>(part.probes[i].element) * npe + a]);
      for (std::size_t c = 0; c < dim; ++c)
        probes[3 * static_cast<std::size_t>(part.probe_index[i]) + c] +=
            part.probes[i].weights[a] * state.omega[node * dim + c];
    }
  part.halo.sum_all(probes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.total_probes); ++i)
    result.probe.push_back({probes[3 * i], probes[3 * i + 1], probes[3 * i + 2]});
}

/// A tangential displacement beyond it is slip.
double least_slip(const OuterLoop& loop, const SolverOptions& options) {
  return 10.0 * options.tolerance * loop.space().max_abs(loop.state().omega);
}

/// Load steps that the run to go on from has behind it, on all ranks.
std::size_t steps_over(const Part& part, const RunOptions& run) {
  const bool here = part.halo.rank == 0 && run.start != nullptr;
  return static_cast<std::size_t>(part.halo.max_all(here ? run.start->number("load_steps_over") : 0.0));
}

/// Whether the next load step has something to start from.
bool worth_going_on(const OuterLoop& loop, const SolverOptions& options, const Result& result) {
  if (!result.message.empty()) return false;
  return options.stop == SolverOptions::Stop::paper ||
         loop.certify().certificate.worst() <= options.tolerance;
}

/// The line of the history for a finished load step; `result` has its totals and those of the steps before.
LoadStep load_step_of(const Result& result, double factor) {
  LoadStep step;
  step.factor = factor;
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

/// The same in the middle of a run.
LoadStep load_step(const Part& part, const OuterLoop& loop, const SolverOptions& options, double factor,
                   const Result& result) {
  Solution now;
  now.result = result;
  collect_contact(part, loop.state(), least_slip(loop, options), now);
  collect_totals(part, loop.state(), now, now.result);
  now.result.certificate = loop.certify().certificate;
  return load_step_of(now.result, factor);
}

std::string verdict(const Result& result, const SolverOptions& options) {
  std::ostringstream text;
  text.precision(2);
  text << std::scientific;
  if (result.status == Status::converged) {
    text << "all KKT residuals are at most " << result.certificate.worst() << " (tolerance "
         << options.tolerance << ")";
  } else if (result.status == Status::interrupted) {
    text << "interrupted after " << result.outer_iterations << " outer steps, with the worst KKT residual at "
         << result.certificate.worst();
  } else if (options.stop == SolverOptions::Stop::paper) {
    text << "stopped by (15) with tolerance " << options.tolerance << ", but the worst KKT residual is "
         << result.certificate.worst() << ": the step was small, the error is not";
  } else {
    text << "after " << result.outer_iterations << " outer steps the worst KKT residual is "
         << result.certificate.worst() << ", above the tolerance " << options.tolerance;
    if (result.bound_change > options.tolerance)
      text << "; Coulomb's bound still moves by " << result.bound_change << " of the pressure a step";
  }
  return text.str();
}

}  // namespace

Solution solve(Part& part, const SolverOptions& options, const RunOptions& run) {
  const double start = MPI_Wtime();
  Solution solution;
  Result& result = solution.result;
  const bool restart = part.halo.any(part.halo.rank == 0 && run.start != nullptr);
  const std::vector<double> factors = options.load_steps.empty() ? std::vector{1.0} : options.load_steps;
  std::optional<LoadPath> path;
  if (factors.size() > 1) {
    path.emplace(part);
    path->set(factors[steps_over(part, run)]);
  }
  OuterLoop loop(part, options, run);
  const double prepared = MPI_Wtime();
  if (restart) loop.restore(run.start, result);
  bool finished = loop.run(result);
  while (finished && result.load_steps.size() + 1 < factors.size() && worth_going_on(loop, options, result)) {
    const std::size_t over = result.load_steps.size();
    result.load_steps.push_back(load_step(part, loop, options, factors[over], result));
    path->set(factors[over + 1]);
    loop.scale(factors[over + 1] / factors[over], result);
    finished = loop.run(result);
  }
  const double looped = MPI_Wtime();

  // The certificate trusts the reference operator only, not the one the loop ran on.
  Vector internal(part.unknowns());
  reference::residual(part.body(), loop.state().omega, internal);
  part.halo.sum(internal, part.dim());
  const double energy = part.halo.sum_all(reference::energy(part.body(), loop.state().omega));
  result.certificate =
      kkt_residuals(loop.space(), loop.traces(), loop.state(), {part.load, internal, energy, loop.diagonal()})
          .certificate;
  result.status = result.certificate.worst() <= options.tolerance ? Status::converged : Status::not_converged;
  if (!finished) result.status = Status::interrupted;
  // What has not converged can be continued with more steps; what has broken down cannot.
  const bool wanted = part.halo.any(part.halo.rank == 0 && run.checkpoint);
  if (wanted && result.status != Status::converged && std::isfinite(result.certificate.worst())) {
    const Checkpoint all = loop.checkpoint(result);
    if (part.halo.rank == 0) run.checkpoint(all);
  }

  solution.displacement = loop.state().omega;
  collect_contact(part, loop.state(), least_slip(loop, options), solution);
  collect_totals(part, loop.state(), solution, result);
  if (result.message.empty()) result.message = verdict(result, options);
  if (path) {
    const std::size_t over = result.load_steps.size();
    if (finished) result.load_steps.push_back(load_step_of(result, factors[over]));
    std::ostringstream place;
    place << "load step " << over + 1 << " of " << factors.size() << " (factor " << factors[over] << "): ";
    if (over + 1 < factors.size() || !finished) result.message = place.str() + result.message;
  }
  if (result.softening_elements > 0)
    result.message +=
        "; " + std::to_string(result.softening_elements) +
        " elements are in the softening range of their law (squared argument), where the problem is not "
        "monotone";
  result.unknowns = part.total_nodes * part.dim();
  result.elements = part.total_elements;
  result.contact_nodes = part.total_contact;
  result.operator_applications = loop.applications();
  result.ranks = part.halo.ranks;
  result.threads = run.threads;
  result.instruction_set = loop.op().local().instruction_set();
  result.peak_memory_bytes =
      static_cast<std::uint64_t>(part.halo.sum_all(static_cast<std::int64_t>(peak_memory())));
  const double end = MPI_Wtime();
  result.seconds = {{"total", end - start},
                    {"prepare", prepared - start},
                    {"spectrum", loop.spectrum_seconds()},
                    {"preconditioner_setup", loop.setup_seconds()},
                    {"solve", looped - prepared - loop.spectrum_seconds() - loop.checkpoint_seconds()},
                    {"checkpoint", loop.checkpoint_seconds()},
                    {"certificate", end - looped}};
  return solution;
}

std::vector<SpectrumResult> analyse_spectrum(const Part& part, const SolverOptions& options,
                                             const RunOptions& run) {
  DistributedOperator op(part, run.threads, run.instruction_set);
  const auto amg = make_preconditioner(options.preconditioner, part, run.threads, run.instruction_set);
  std::vector<double> secant(part.body().secant_count());
  op.local().secant(secant);
  std::vector<SpectrumResult> results;
  if (part.total_contact == 0) return results;
  results.push_back(
      estimate_spectrum(part, op, *amg, secant, false, {options.spectrum_tolerance, options.max_cg}));
  bool slides = false;
  for (const auto& point : part.contact) slides = slides || point.tangents > 0;
  if (part.halo.any(slides))
    results.push_back(
        estimate_spectrum(part, op, *amg, secant, true, {options.spectrum_tolerance, options.max_cg}));
  return results;
}

double active_penalty(const Part& part, const Solution& solution, const SolverOptions& options,
                      const RunOptions& run) {
  DistributedOperator op(part, run.threads, run.instruction_set);
  op.update(solution.displacement);
  const auto amg = make_preconditioner(options.preconditioner, part, run.threads, run.instruction_set);
  std::vector<double> secant(part.body().secant_count());
  op.local().secant(secant);
  std::vector<TraceChoice> active(part.contact.size()), open(part.contact.size());
  for (std::size_t i = 0; i < active.size(); ++i) {
    active[i] = {solution.pressure[i] > 0.0, solution.contact_status[i] == ContactStatus::stick};
    open[i] = {!active[i].normal, !active[i].tangential};
  }
  const TraceRows held(part, active), free(part, open);
  if (held.total() == 0) return 0.0;
  Spectrum spectrum(part, op, *amg, secant, {options.spectrum_tolerance, options.max_cg});
  const double low = spectrum.smallest(held).value;
  if (!(low > 0.0)) return 0.0;
  const double high =
      free.total() > 0 ? spectrum.largest(free, held, 0.01 / low, part.loose_modes > 0).value : 0.0;
  return 1.0 / std::sqrt(low * (high > 0.0 ? high : low));
}

}  // namespace kacanov
