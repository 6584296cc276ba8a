// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kačanov's or Newton's method around a contact step, until the KKT residuals are small.
#include "nonlinear/outer_loop.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mesh/classic_locale_stream.hpp"
#include "nonlinear/body_response.hpp"
#include "nonlinear/friction_bounds.hpp"
#include "nonlinear/step.hpp"
#include "partition/global_max.hpp"
#include "spectrum/spectrum.hpp"

namespace kacanov {
namespace {

/// Returns the initial penalty if the user has set none.
double own_first_penalty(const StepContext& context) {
  const Part& part = context.part;
  if (part.total_contact == 0) return 0.0;
  return first_penalty(rough_lambda_min(part, context.body.diagonal(), false), part.total_contact, part.dim(),
                       context.tuning);
}

/// Returns the largest displacement that is prescribed or used as start of loose pieces.
double imposed(const Part& part) {
  double largest = 0.0;
  for (const auto& entry : part.prescribed) largest = std::max(largest, std::abs(entry.value));
  for (const HeldDirection& held : part.directions) largest = std::max(largest, std::abs(held.value));
  for (const double value : part.start) largest = std::max(largest, std::abs(value));
  return part.node_map.max_all(largest);
}

/// Returns λ_max without held rows, with the preconditioner in its current state.
double rough_largest(StepContext& context) {
  const Part& part = context.part;
  const std::size_t points = part.contact.size();
  // Friction has modes 1.15 (2D) and 1.3 times softer, on beams, than those of pressure.
  constexpr double with_friction = 1.2;
  return (has_friction(part) ? with_friction : 1.0) *
         rough_lambda_max(part, context.body.op(), context.preconditioner.inner(),
                          TraceRows(part, std::vector<TraceChoice>(points, {true, false})),
                          TraceRows(part, std::vector<TraceChoice>(points)), context.tuning.rough_iterations);
}

}  // namespace

OuterLoop::OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run, double share,
                     const Tuning& tuning)
    : options_(options),
      run_(run),
      start_(MPI_Wtime()),
      context_(part, options, run, tuning),
      control_{PenaltyControl(options, own_first_penalty(context_), tuning),
               Linearisation(options.outer, context_.body.linear(), tuning), Fallback(tuning),
               AugmentedControl(tuning)},
      friction_(has_friction(part)),
      history_(has_slip_history(part)),
      stoppable_(part.node_map.any(run.stop_requested != nullptr)),
      extent_(body_extent(part)),
      largest_imposed_(imposed(part)) {
  context_.path.go_to(share);
  take_load();
  if (stoppable_) {
    DistributedOperator& op = context_.body.op();
    op.watch([this, &op] {
      if (op.applications() % context_.tuning.applications_per_question == 0 && stop_agreed())
        throw Interrupted{};
    });
  }
}

void OuterLoop::take_load() {
  ContactState& state = context_.state;
  context_.path.prescribe(state.u);
  context_.take_temperature();
  state.gap = context_.path.gap();
  state.evaluate(context_.traces);
  for (std::size_t i = 0; i < state.gap.size(); ++i)
    state.phi.normal[i] = std::min(state.trace.normal[i], state.gap[i]);
  // Points that an obstacle has passed do not stick before they have touched: such a step would leave noise
  // where nothing acts.
  if (opening_ && !context_.part.slip_origin.empty()) state.phi.tangential = state.trace.tangential;
  follow_pressure(context_.part, state.lambda.normal, state.bound);
}

double OuterLoop::step_begin() const {
  if (parts.start) return parts.start->share;
  const std::vector<LoadFactors>& curves = context_.part.steps;
  return curves.empty() ? 0.0 : curves.front().time;
}

OuterLoop::Place OuterLoop::rest() const {
  Place place{context_.state, step_begin(), true};
  put_to_rest(context_.part, place.state);
  // After a restart the origin is the end of the previous load step, which the part does not store.
  place.state.origin = context_.state.origin;
  return place;
}

OuterLoop::Place OuterLoop::next_start() const {
  Place start = place();
  if (history_) start.state.count_slip_from_here(context_.traces.points());
  return start;
}

void OuterLoop::go_from(const Place& place, double share, const Result& result) {
  opening_ = place.at_rest;
  adopted_ = false;
  double ratio = 1.0;
  if (opening_) {
    control_.penalty.go_back_to_first();
  } else {
    context_.path.go_to(place.share);
    if (!history_) ratio = context_.path.growth_to(share);
  }
  context_.path.go_to(share);
  ContactState& state = context_.state;
  state = place.state;
  for (Vector* v : {&state.u, &state.lambda.normal, &state.lambda.tangential, &state.phi.tangential})
    for (double& value : *v) value *= ratio;
  take_load();
  control_.linearisation.start_again();
  control_.fallback.start_again();
  first_outer_ = result.outer_iterations;
  within_ = false;
}

void OuterLoop::take(const Start& start) {
  ContactState& state = context_.state;
  state.u = start.displacement;
  state.lambda.normal = start.pressure;
  state.lambda.tangential = start.friction;
  take_load();
  state.phi.tangential = state.trace.tangential;
}

void OuterLoop::adopt(const Start& start) {
  adopted_ = true;
  coarse_lambda_max_ = start.lambda_max;
  take(start);
}

void OuterLoop::go_along(const Place& place, double share, const Start& start, const Result& result) {
  go_from(place, share, result);
  take(start);
}

void OuterLoop::stand_at(const Place& place, const Result& result) {
  go_from(place, place.share, result);
  context_.body.evaluate(context_.state.u);
}

void OuterLoop::take_rest_if_solution() {
  const Part& part = context_.part;
  if (!context_.path.idle()) return;
  const ContactState before = context_.state;
  Start rest;
  rest.displacement = part.start;
  rest.displacement.resize(part.unknowns(), 0.0);
  rest.pressure.assign(part.contact.size(), 0.0);
  rest.friction.assign(2 * part.contact.size(), 0.0);
  take(rest);
  context_.body.evaluate(context_.state.u);
  if (certify().certificate.worst() > 0.0) context_.state = before;
}

void OuterLoop::open_if_at_rest(const Residuals& residuals) {
  // Without pressure the scale of penetrations is a thousandth of the displacement (theory: kkt).
  const bool at_rest =
      residuals.scales.displacement == 0.0 || residuals.certificate.penetration * options_.tolerance > 1e3;
  if ((opening_ && !adopted_) || !at_rest) return;
  opening_ = true;
  adopted_ = false;
  control_.penalty.go_back_to_first();
  context_.state.phi.tangential = context_.state.trace.tangential;
}

void OuterLoop::iterate(Result& result) {
  const bool goes_on = std::exchange(resumes_, false) && within_;
  within_ = goes_on;
  keep(result);
  if (!control_.penalty.chosen()) choose_first_penalty(result);
  gave_up_ = false;
  changes_.start_again();
  const bool by_step = options_.stop == SolverOptions::Stop::paper;
  const bool may_newton = !by_step && (options_.contact == SolverOptions::Contact::automatic ||
                                       options_.contact == SolverOptions::Contact::active_set);
  const int before_this_call = result.outer_iterations;
  const ContactState& state = context_.state;
  if (!goes_on) {
    if (!opening_ || adopted_) take_rest_if_solution();
    context_.body.evaluate(state.u);
  }
  Residuals residuals = certify();
  if (!goes_on) {
    open_if_at_rest(residuals);
    best_.worst = HUGE_VAL;
  }
  bool done = false;
  Vector previous;
  while (!done && result.outer_iterations - first_outer_ < options_.max_outer) {
    if (result.outer_iterations > before_this_call) keep(result);
    if (by_step) previous = state.u;
    const bool newton = may_newton && (adopted_ || !opening_) && !control_.fallback.retreating();
    const Residuals before = residuals;
    const StepOutcome step = take_step(newton, before, result);
    result.bound_change = follow_pressure(context_.part, state.lambda.normal, context_.state.bound);
    changes_.note(context_.part.contact.points(), state);
    residuals = certify();
    if (!step.balance.empty()) move_penalty(step, before, residuals, result);
    opening_ = false;
    within_ = true;
    report(step, residuals, result);
    result.message = hopeless(residuals, newton);
    gave_up_ = !result.message.empty();
    if (gave_up_) return;
    if (by_step) {
      for (std::size_t i = 0; i < previous.size(); ++i) previous[i] -= state.u[i];
      done = context_.body.linear() ||
             context_.space.norm(previous) <= options_.tolerance * context_.space.norm(state.u);
    } else {
      // Far beyond the body's size reactions exceed the loads, and relative residuals become meaningless.
      done = residuals.certificate.exhausted(options_.tolerance) && !ran_away(residuals);
      if (!done) residuals = learn(step, newton, before, residuals, result.lambda_min);
      gave_up_ = !done && may_newton && control_.fallback.stuck();
      if (gave_up_) return;
    }
  }
}

StepOutcome OuterLoop::take_step(bool newton, const Residuals& before, Result& result) {
  const Penalty& penalty = control_.penalty.value();
  if (control_.fallback.retreating() && !control_.augmented.begun())  // after a restart
    control_.augmented.begin(penalty.normal, result.lambda_min);
  const bool tangent = newton && control_.linearisation.takes_tangent(before.unbalanced);
  const StepOutcome step = newton ? newton_step(context_, penalty.normal, tangent, before)
                           : control_.fallback.retreating()
                               ? augmented_step(context_, control_.augmented, before)
                               : admm_step(context_, penalty, before, opening_);
  ++result.outer_iterations;
  result.contact_iterations += step.contact_iterations;
  result.cg_iterations += step.cg_iterations;
  result.contact_applications += step.applications;
  if (!step.solved) ++result.unsolved_steps;
  result.r.push_back(penalty.normal);
  return step;
}

void OuterLoop::move_penalty(const StepOutcome& step, const Residuals& before, const Residuals& after,
                             Result& result) {
  if (control_.penalty.has_rule()) {
    control_.penalty.follow_rule(step.evidence, context_.traces);
    result.r_active = control_.penalty.value().normal;
    return;
  }
  // Before the first step there is no displacement scale.
  const bool first = opening_;
  const bool moved = step.arrived
                         ? control_.penalty.go_back_to_first()
                         : control_.penalty.balance(step.balance, first ? after.scales : before.scales);
  if (moved && !first) result.r_active = control_.penalty.value().normal;
}

Residuals OuterLoop::learn(const StepOutcome& step, bool newton, const Residuals& before,
                           const Residuals& after, double lambda_min) {
  const double worst = after.certificate.worst();
  keep_best(after, newton);
  if (!newton) {
    // As after an unsolved Newton step, the preconditioner is the likely cause.
    if (!step.solved) context_.preconditioner.mark_stale();
    control_.fallback.after_fallback_step(worst, step.solved);
    return after;
  }
  if (step.tangent)
    control_.linearisation.after_tangent(before.unbalanced, after.unbalanced, step.length);
  else
    control_.linearisation.after_secant();
  if (!control_.fallback.after_newton(worst, step.solved && !ran_away(after))) return after;
  context_.preconditioner.mark_stale();
  if (!best_.by_multipliers) control_.augmented.begin(control_.penalty.value().normal, lambda_min);
  return go_back();
}

void OuterLoop::keep_best(const Residuals& residuals, bool newton) {
  const double worst = residuals.certificate.worst();
  const bool retreating = !newton && control_.fallback.retreating();
  if ((retreating || worst < best_.worst) && !ran_away(residuals))
    best_ = {context_.state, worst, retreating};
}

Residuals OuterLoop::go_back() {
  if (best_.worst < HUGE_VAL) context_.state = best_.state;
  for (double& pressure : context_.state.lambda.normal) pressure = std::max(pressure, 0.0);
  follow_pressure(context_.part, context_.state.lambda.normal, context_.state.bound);
  context_.body.evaluate_and_freeze(context_.state.u);
  return certify();
}

bool OuterLoop::ran_away(const Residuals& residuals) const {
  return residuals.scales.displacement >
         context_.tuning.most_displacement * std::max(extent_, largest_imposed_);
}

std::string OuterLoop::hopeless(const Residuals& residuals, bool newton) const {
  const double moved = residuals.scales.displacement;
  if (newton) return {};
  if (!std::isfinite(residuals.certificate.worst()))
    return "the iteration broke down: residuals are not finite";
  if (options_.stop == SolverOptions::Stop::paper || !ran_away(residuals)) return {};
  PlainText text;
  text.precision(3);
  text << "the displacement has grown to " << moved / extent_
       << " times the body's size: the load is beyond what the material or the supports can carry";
  return text.str();
}

void OuterLoop::report(const StepOutcome& step, const Residuals& residuals, const Result& result) const {
  if (!run_.progress || context_.part.node_map.rank != 0) return;
  ProgressStep line;
  line.phase = step.method;
  line.outer = result.outer_iterations;
  line.contact_iterations = step.contact_iterations;
  line.cg_iterations = step.cg_iterations;
  line.r = result.r.back() * units_.penalty();
  line.energy = residuals.energy * units_.energy();
  line.certificate = residuals.certificate;
  line.seconds = MPI_Wtime() - start_;
  run_.progress(line);
}

void OuterLoop::choose_first_penalty(Result& result) {
  const Part& part = context_.part;
  if (part.total_contact == 0) return;
  const double before = MPI_Wtime();
  DistributedOperator& op = context_.body.op();
  const auto applications = op.applications();
  if (options_.penalty == SolverOptions::Penalty::paper) {
    const auto spectrum = estimate_spectrum(part, op, context_.preconditioner.lend(), context_.body.secant(),
                                            friction_, {options_.spectrum_tolerance, options_.max_cg});
    result.lambda_min = spectrum.lambda_min;
    result.lambda_max = spectrum.lambda_max;
    result.r_star = spectrum.r_star;
    result.cg_iterations += spectrum.cg_iterations;
    if (!spectrum.converged)
      result.warnings.push_back(
          "solver.r: the estimate of the spectrum behind r* has not converged, so that the "
          "penalty is a rough one (solver.max_cg, solver.spectrum_tolerance)");
    control_.penalty.choose(result.r_star, result.lambda_min);
  } else {
    result.lambda_min = rough_lambda_min(part, context_.body.diagonal(), friction_);
    control_.penalty.choose(0.0, result.lambda_min);
    if (adopted_) {
      result.lambda_max = coarse_lambda_max_;
    } else {
      context_.preconditioner.set_up(control_.penalty.value());
      if (part.loose_modes == 0) result.lambda_max = rough_largest(context_);
    }
    if (result.lambda_min > 0.0 && result.lambda_max > 0.0)
      result.r_star = 1.0 / std::sqrt(result.lambda_min * result.lambda_max);
  }
  result.spectrum_applications += op.applications() - applications;
  spectrum_seconds_ += MPI_Wtime() - before;
}

}  // namespace kacanov
