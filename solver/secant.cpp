// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kacanov's method (7) round the contact loop.
#include "secant.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace kacanov {
namespace {

/// The contact loop of an outer step is taken this far below the residual of the step before.
constexpr double inner_reduction = 0.2;
/// AMG is rebuilt when a CG iteration gains less than this share of the digits it gained after the last setup.
constexpr double rebuild_share = 0.6;
/// Contact iterations with (32) before the active set is good enough to estimate r_A from it.
constexpr int settling_iterations = 25;

Vector lumped_volume(const Part& part) {
  Vector volume(part.nodes(), 0.0), element(part.element_index.size());
  reference::volumes(part.body(), element);
  const auto npe = static_cast<std::size_t>(nodes_per_element(part.type));
  for (std::size_t k = 0; k < part.elements.size(); ++k)
    volume[static_cast<std::size_t>(part.elements[k])] += element[k / npe] / static_cast<double>(npe);
  part.halo.sum(volume, 1);
  return volume;
}

}  // namespace

OuterLoop::OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run)
    : part_(part),
      options_(options),
      run_(run),
      start_(MPI_Wtime()),
      space_(part),
      traces_(part),
      op_(part, run.threads, run.instruction_set),
      amg_(part),
      internal_(part.unknowns()),
      secant_(part.body().secant_count()) {
  const std::size_t points = part.contact.size();
  state_.omega = part.prescribed;
  for (std::size_t i = 0; i < part.unknowns(); ++i)
    if (!part.held[i]) state_.omega[i] = 0.0;
  state_.trace = state_.phi = state_.lambda = ContactValues(points);
  state_.bound.resize(points);
  work_.resize(part.unknowns());
  traces_.evaluate(state_.omega, state_.trace);
  for (std::size_t i = 0; i < points; ++i)
    state_.phi.normal[i] = std::min(state_.trace.normal[i], part.contact[i].gap);
  bool slides = false;
  for (const auto& point : part.contact) slides = slides || point.tangents > 0;
  friction_ = part.halo.max_all(slides ? 1.0 : 0.0) > 0.0;
  if (options.stop == SolverOptions::Stop::paper) volume_ = lumped_volume(part);
  update_bounds();
  // The first secant is the elastic one: prescribed displacements put in at once would look like huge
  // strains in the first layer of elements.
  op_.local().secant(secant_);
}

void OuterLoop::update_bounds() {
  for (std::size_t i = 0; i < part_.contact.size(); ++i)
    state_.bound[i] = part_.contact[i].tresca + part_.contact[i].coulomb * state_.lambda.normal[i];
}

void OuterLoop::note(const std::string& text) const {
  if (!run_.progress || part_.halo.rank != 0) return;
  ProgressStep step;
  step.phase = "note";
  step.note = text;
  step.seconds = MPI_Wtime() - start_;
  run_.progress(step);
}

void OuterLoop::report(const Result&, const ProgressStep& step) const {
  if (run_.progress && part_.halo.rank == 0) run_.progress(step);
}

void OuterLoop::choose_first_penalty(Result& result) {
  if (part_.total_contact == 0) return;
  const double before = MPI_Wtime();
  const auto spectrum = estimate_spectrum(part_, op_, amg_, secant_, friction_, options_.spectrum_tolerance);
  preconditioner_stale_ = true;
  result.lambda_min = spectrum.lambda_min;
  result.lambda_max = spectrum.lambda_max;
  result.r_star = spectrum.r_star;
  result.cg_iterations += spectrum.cg_iterations;
  spectrum_seconds_ += MPI_Wtime() - before;
  const double r = options_.penalty == SolverOptions::Penalty::fixed ? options_.r : spectrum.r_star;
  penalty_ = {r, r};
}

bool OuterLoop::improve_penalty(Result& result, int outer) {
  if (part_.total_contact == 0 || options_.penalty != SolverOptions::Penalty::automatic) return false;
  static_cast<void>(outer);
  const double before = MPI_Wtime();
  std::vector<TraceChoice> active(part_.contact.size()), free(part_.contact.size());
  for (std::size_t i = 0; i < part_.contact.size(); ++i) {
    const bool pressed = state_.lambda.normal[i] > 0.0;
    const bool stick = std::hypot(state_.lambda.tangential[2 * i], state_.lambda.tangential[2 * i + 1]) <
                       state_.bound[i] * (1.0 - 1e-12);
    active[i] = {pressed, stick};
    free[i] = {!pressed, !stick};
  }
  const TraceRows held(part_, active), open(part_, free);
  if (held.total() == 0) return false;
  const double tolerance = std::max(options_.spectrum_tolerance, 5e-2);
  Spectrum spectrum(part_, op_, amg_, secant_, tolerance);
  const Eigenvalue low = spectrum.smallest(held);
  Eigenvalue high;
  if (open.total() > 0) high = spectrum.largest(open, held, low.value > 0.0 ? 0.01 / low.value : 1.0, part_.loose_modes > 0);
  preconditioner_stale_ = true;
  result.cg_iterations += spectrum.cost().cg_iterations;
  spectrum_seconds_ += MPI_Wtime() - before;
  if (!(low.value > 0.0)) return false;
  // With nothing free the larger r the better, until CG pays for it: three times 1/λ_min contracts by a quarter.
  const double r = high.value > 0.0 ? 1.0 / std::sqrt(low.value * high.value) : 3.0 / low.value;
  if (!std::isfinite(r)) return false;
  penalty_ = {r, r};
  result.r_active = r;
  ++estimates_;
  return true;
}

void OuterLoop::set_up_preconditioner() {
  const std::vector<TraceChoice> all(part_.contact.size(), {true, true});
  const auto dim = static_cast<std::size_t>(part_.dim());
  std::vector<NodeBlock> blocks;
  for (const auto& point : std::span(part_.contact).first(static_cast<std::size_t>(part_.owned_contact))) {
    NodeBlock block{point.node, {}};
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j) {
        double& v = block.value[i * dim + j];
        v = penalty_.normal * point.mass * point.trace[i] * point.trace[j];
        for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
          v += penalty_.tangential * point.mass * point.tangent[k][i] * point.tangent[k][j];
      }
    blocks.push_back(block);
  }
  amg_.setup(secant_, blocks);
  preconditioner_stale_ = false;
  digits_per_cg_ = 0.0;
}

void OuterLoop::refresh_secant() {
  op_.update(state_.omega);
  op_.local().secant(secant_);
}

Residuals OuterLoop::evaluate() {
  op_.residual(state_.omega, internal_);
  return kkt_residuals(space_, traces_, state_, internal_, op_.energy(state_.omega));
}

void OuterLoop::run(Result& result) {
  choose_first_penalty(result);
  const bool by_step = options_.stop == SolverOptions::Stop::paper;
  const bool automatic = options_.penalty == SolverOptions::Penalty::automatic;
  const double alpha =
      options_.relaxation.value_or(by_step || options_.penalty == SolverOptions::Penalty::paper ? 1.0 : 1.7);
  const bool linear = std::all_of(part_.laws.begin(), part_.laws.end(),
                                  [](const Law& law) { return law.kind == Law::Kind::linear; });
  const LinearProblem problem{&space_, &traces_,
                              [this](std::span<const double> x, std::span<double> y) { op_.apply(x, y); },
                              [this](std::span<const double> r, std::span<double> z) { amg_.apply(r, z); }};
  Residuals residuals = evaluate();
  bool done = false;
  Vector previous;
  while (!done && result.outer_iterations < options_.max_outer) {
    const int outer = result.outer_iterations;
    // The elastic secant serves the first step; later ones freeze g at the last iterate.
    if (outer > 0 && !linear) refresh_secant();
    const bool settled = outer > 0 && estimates_ == 0 && automatic;
    if (settled) improve_penalty(result, outer);
    if (preconditioner_stale_) set_up_preconditioner();

    AdmmOptions admm_options;
    admm_options.r = penalty_;
    admm_options.relaxation = alpha;
    const double worst = std::max(residuals.certificate.worst(), residuals.scales.displacement == 0.0 ? 1.0 : 0.0);
    const double reach = std::max(0.5 * options_.tolerance, inner_reduction * std::min(worst, 1.0));
    admm_options.max_iterations = options_.max_contact;
    if (by_step) {
      admm_options.step_tolerance = options_.tolerance;
      admm_options.force_tolerance = 1e-2 * options_.tolerance * residuals.scales.force;
      admm_options.volume = volume_;
      previous = state_.omega;
    } else {
      admm_options.force_tolerance = reach * residuals.scales.force;
      // With no displacement yet, any trace will do: the first step ends by its forces.
      admm_options.trace_tolerance =
          residuals.scales.displacement > 0.0 ? reach * residuals.scales.displacement : HUGE_VAL;
      if (automatic && estimates_ == 0) admm_options.max_iterations = std::min(settling_iterations, options_.max_contact);
    }
    work_.residual = part_.load;
    for (std::size_t i = 0; i < work_.residual.size(); ++i) work_.residual[i] -= internal_[i];
    traces_.add_force(state_.lambda, -1.0, work_.residual);
    if (outer == 0) {
      // internal_ is the true R(ω) of a state with prescribed displacements only; the first step is elastic.
      op_.apply(state_.omega, internal_);
      work_.residual = part_.load;
      for (std::size_t i = 0; i < work_.residual.size(); ++i) work_.residual[i] -= internal_[i];
    }
    const AdmmResult step = admm(problem, state_, work_, admm_options);
    ++result.outer_iterations;
    result.contact_iterations += step.iterations;
    result.cg_iterations += step.cg_iterations;
    result.r.push_back(penalty_.normal);
    if (step.cg_iterations > 0) {
      const double rate = step.cg_digits / static_cast<double>(step.cg_iterations);
      if (digits_per_cg_ == 0.0) digits_per_cg_ = rate;
      if (rate < rebuild_share * digits_per_cg_) preconditioner_stale_ = true;
    }
    update_bounds();
    residuals = evaluate();
    ProgressStep line;
    line.phase = "outer";
    line.outer = result.outer_iterations;
    line.contact_iterations = step.iterations;
    line.cg_iterations = step.cg_iterations;
    line.r = penalty_.normal;
    line.energy = op_.energy(state_.omega);
    line.certificate = residuals.certificate;
    line.seconds = MPI_Wtime() - start_;
    report(result, line);
    if (!std::isfinite(residuals.certificate.worst())) {
      result.message = "the iteration broke down: residuals are not finite";
      return;
    }
    if (by_step) {
      double change = 0.0, size = 0.0;
      for (std::size_t i = 0; i < previous.size(); ++i) previous[i] -= state_.omega[i];
      change = space_.norm(previous);
      size = space_.norm(state_.omega);
      done = linear || change <= options_.tolerance * size;
    } else {
      done = residuals.certificate.worst() <= options_.tolerance;
    }
  }
}

}  // namespace kacanov
