// SPDX-License-Identifier: BSD-3-Clause
// Runs the load steps, and records their history.
#include "nonlinear/load_steps.hpp"

#include <algorithm>
#include <string>

#include <kacanov/part.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "nonlinear/convergence_diagnosis.hpp"
#include "partition/nondimensionalisation.hpp"
#include "results/collect.hpp"

namespace kacanov {
namespace {

/// Returns the history line of a load step in the middle of a run.
LoadStep line_now(const OuterLoop& loop, double share, const Result& result) {
  const StepContext& context = loop.context();
  Solution now;
  now.result = result;
  now.corner_dilatation = corner_dilatation(context.part, context.state.u);
  collect_contact(context.part, context.state, context.options.tolerance, now);
  collect_totals(context.part, context.state, now);
  now.result.certificate = context.certify().certificate;
  LoadStep line = load_step_line(now.result, share);
  redimensionalise(line, loop.units());
  return line;
}

/// Returns the largest displacement of a state, divided by its share of the load.
double stretched(const OuterLoop& loop, const OuterLoop::Place& place) {
  return loop.context().space.max_abs(place.state.u) / place.share;
}

/// Explains why nothing beyond `last` converges; `failed`: end of the last attempt.
std::string explain_stop(const OuterLoop& loop, const OuterLoop::Place& last, double target,
                         const OuterLoop::Place& failed, const std::string& why) {
  PlainText text;
  text.precision(4);
  if (last.at_rest) {
    text << "no state of balance is found, not even under a small part of the load";
    if (last.share > 0.0) text << " of this step";
    text << ": " << why;
    return text.str();
  }
  constexpr double collapsing = 2.0;
  const bool collapse =
      !loop.context().body.linear() && stretched(loop, failed) > collapsing * stretched(loop, last);
  text << (collapse ? "plastic collapse: the body carries " : "contact and friction do not settle beyond ")
       << "the load factor " << last.share << " of " << target
       << (collapse ? " and not " : "; tried in vain: ") << failed.share
       << ". Numbers and fields are those of " << last.share;
  text << "; at " << failed.share << ": " << why;
  return text.str();
}

/// Whether the state is good enough to start the next load step from.
bool worth_going_on(const OuterLoop& loop, const Result& result) {
  if (!result.message.empty()) return false;
  const SolverOptions& options = loop.context().options;
  return options.stop == SolverOptions::Stop::paper ||
         loop.context().certify().certificate.exhausted(options.tolerance);
}

/// Runs the loop at its current load; returns whether it has converged there.
bool arrives(OuterLoop& loop, bool& finished, Result& result) {
  finished = loop.run(result);
  const bool arrived = finished && result.message.empty() &&
                       loop.context().certify().certificate.exhausted(loop.context().options.tolerance);
  if (arrived) result.load_reached = loop.context().path.share();
  return arrived;
}

/// Explains why it did not converge.
std::string reason(const OuterLoop& loop, const Result& result) {
  return result.message.empty() ? diagnose_convergence(loop) : result.message;
}

/// Brings the loop, already set to `target`, to convergence; if it gives up, in parts from loop.parts.start:
/// a part is halved until it converges, and doubled after the second convergence in a row. Continues a part
/// after a restart. Returns false if the run was asked to stop.
bool reach(OuterLoop& loop, double target, Result& result) {
  OuterLoop::StepParts& parts = loop.parts;
  bool finished = true, under_way = parts.cut;
  if (!under_way) {
    if (arrives(loop, finished, result) || !finished || !loop.gave_up()) return finished;
    if (result.cg_iterations == 0) {
      result.message =
          "no linear problem could be solved: elements that are next to flat, parts far stiffer than others, "
          "or a Poisson's ratio next to 0.5, leave no definite operator in this arithmetic; kacanov check "
          "names the worst element";
      return true;
    }
    parts.cut = true;
    parts.whole = loop.place();
    parts.last = parts.start ? *parts.start : loop.rest();
    parts.over = 0.0;
    parts.part = 0.5;
  }
  const double from = loop.step_begin();
  OuterLoop::Place failed = parts.whole;
  std::string why = under_way ? std::string() : reason(loop, result);
  for (; parts.part >= loop.context().tuning.smallest_part; parts.part *= 0.5) {
    if (!under_way) {
      ++result.load_cuts;
      parts.again = false;
    }
    while (parts.over < 1.0) {
      if (!under_way) {
        parts.next = std::min(parts.over + parts.part, 1.0);
        parts.part = parts.next - parts.over;  // the actual length, so that halving takes effect
        loop.go_from(parts.last, parts.next == 1.0 ? target : from + parts.next * (target - from), result);
      }
      under_way = false;
      const bool arrived = arrives(loop, finished, result);
      if (!finished) return false;
      if (!arrived) break;
      parts.over = parts.next;
      parts.last = loop.place();
      if (parts.again) parts.part *= 2.0;  // a length that was just halved would fail again if doubled
      parts.again = true;
    }
    if (parts.over == 1.0) break;
    why = reason(loop, result);
    failed = loop.place();
  }
  parts.cut = false;
  if (parts.over == 1.0) return true;
  result.message = explain_stop(loop, parts.last, target, failed, why);
  loop.stand_at(parts.last.at_rest ? parts.whole : parts.last, result);
  return true;
}

}  // namespace

bool run_load_steps(OuterLoop& loop, std::span<const double> shares, Result& result,
                    const LoadStepCalls& calls) {
  for (;;) {
    const std::size_t over = result.load_steps.size();
    if (calls.begins) calls.begins(over);
    const bool finished = reach(loop, shares[over], result);
    if (!finished || over + 1 == shares.size() || !worth_going_on(loop, result)) return finished;
    result.load_steps.push_back(line_now(loop, shares[over], result));
    if (calls.over) calls.over();
    loop.parts = OuterLoop::StepParts();
    loop.parts.start = loop.next_start();
    if (calls.coarse)
      loop.go_along(*loop.parts.start, shares[over + 1], calls.coarse(over + 1), result);
    else
      loop.go_from(*loop.parts.start, shares[over + 1], result);
  }
}

std::string load_step_name(std::size_t number, std::size_t of, bool by_time, double at) {
  PlainText name;
  name << "load step " << number + 1 << " of " << of << (by_time ? " (time " : " (factor ") << at << ")";
  return name.str();
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
