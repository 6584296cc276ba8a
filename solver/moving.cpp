// SPDX-License-Identifier: BSD-3-Clause
// Solving where obstacles move, are pushed by a force, or are faced anew at each load step.
#include <kacanov/moving.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include "load_steps.hpp"
#include "mesh/plain_stream.hpp"
#include "moving_contact.hpp"
#include "parallel/body_extent.hpp"
#include "problem/vector3.hpp"
#include "pushed_obstacle.hpp"

namespace kacanov {
namespace {

/// Adds the counts and times of the solves before to those of one.
void add(Result& result, const Result& before) {
  const auto add_all = [](auto& sum, const auto& more, auto... entries) {
    ((sum.*entries += more.*entries), ...);
  };
  add_all(result, before, &Result::outer_iterations, &Result::cg_iterations, &Result::contact_iterations,
          &Result::unsolved_steps, &Result::load_cuts, &Result::operator_applications,
          &Result::spectrum_applications, &Result::contact_applications);
  add_all(result.seconds, before.seconds, &PhaseSeconds::total, &PhaseSeconds::prepare,
          &PhaseSeconds::spectrum, &PhaseSeconds::preconditioner_setup, &PhaseSeconds::solve,
          &PhaseSeconds::checkpoint, &PhaseSeconds::certificate);
  result.r.insert(result.r.begin(), before.r.begin(), before.r.end());
  std::vector<std::string> warnings = before.warnings;
  for (std::string& warning : result.warnings)
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
      warnings.push_back(std::move(warning));
  result.warnings = std::move(warnings);
}

/// The solves of a run, each from the end of the one before.
class Chain {
 public:
  Chain(Part& part, const Model& model, const RunOptions& run)
      : part_(part),
        model_(model),
        run_(run),
        contact_(part, model),
        curves_(part.steps),
        extent_(body_extent(part)) {
    run_.checkpoint = nullptr;
    over_ = std::move(run_.load_step_over);
    run_.load_step_over = nullptr;
    run_.start = nullptr;
    if (!run_.coarse.empty() && !run_.coarse[0].at_rest()) start_ = interpolate(run_.coarse[0], part);
    run_.coarse = {};
    u_.assign(part.unknowns(), 0.0);
    for (std::size_t e = 0; e < model.contact.size(); ++e)
      if (model.contact[e].force_controlled) pushed_.push_back({e, {}});
  }

  Solution run() {
    std::vector<LoadStep> lines;
    double reached = 0.0;
    for (std::size_t k = 1; k < curves_.size(); ++k) {
      const double time = curves_[k].time;
      // Between the two the load is cut, where that has to be.
      part_.steps = {still(curves_[k - 1]), still(curves_[k])};
      if (curves_.size() > 2)
        tell(load_step_name(k - 1, curves_.size() - 1, !model_.steps_are_factors, time));
      contact_.face(time, curves_[k - 1].time, u_);
      const int outer = last_.result.outer_iterations;
      const std::int64_t cg = last_.result.cg_iterations;
      const bool arrived = push_all(curves_[k].contact);
      u_ = last_.displacement;
      const Result& result = last_.result;
      if (!result.load_steps.empty()) {
        LoadStep line = result.load_steps.back();
        line.outer_iterations = result.outer_iterations - outer;
        line.cg_iterations = result.cg_iterations - cg;
        for (const ContactTotals& contact : result.contact) line.travel.push_back(contact.travel);
        lines.push_back(line);
      }
      if (arrived)
        reached = time;
      else if (!pushes_ && result.load_reached > 0.0)  // by a part of the step
        reached = result.load_reached;
      if (!arrived) {
        end_early(k, time);
        break;
      }
      if (over_ && k + 1 < curves_.size()) {
        last_.result.load_steps = lines;
        last_.result.by_time = !model_.steps_are_factors;
        over_(part_, last_);
      }
    }
    last_.result.load_steps = std::move(lines);
    last_.result.by_time = !model_.steps_are_factors;
    last_.result.load_reached = reached;
    return std::move(last_);
  }

 private:
  /// Factors, but that obstacles which move are not drawn back by theirs.
  LoadFactors still(LoadFactors factors) const {
    for (std::size_t e = 0; e < factors.contact.size(); ++e)
      if (model_.contact[e].moves()) factors.contact[e] = 1.0;
    return factors;
  }

  void tell(const std::string& stage) const {
    if (run_.stage && part_.node_map.rank == 0) run_.stage(stage);
  }

  /// Solves from where the last solve has ended; counts, times and warnings go on.
  void solve_once() {
    const Result before = std::move(last_.result);
    RunOptions run = run_;
    run.from = start_.displacement.empty() ? nullptr : &start_;
    if (run_.progress)
      run.progress = [&](ProgressStep step) {
        step.outer += before.outer_iterations;
        step.seconds += before.seconds.total;
        run_.progress(step);
      };
    last_ = solve(part_, model_.solver, run);
    add(last_.result, before);
    start_.displacement = last_.displacement;
    start_.pressure = last_.pressure;
    start_.friction.assign(2 * part_.contact.size(), 0.0);
    for (std::size_t i = 0; i < part_.contact.size(); ++i)
      for (int k = 0; k < part_.contact[i].tangents; ++k)
        start_.friction[2 * i + static_cast<std::size_t>(k)] =
            -dot(last_.traction[i], part_.contact[i].tangent[k]);
    start_.lambda_max = last_.result.lambda_max;
  }

  /// A contact entry that is pushed by a force, in this load step.
  struct Pushed {
    std::size_t entry = 0;
    PushedObstacle search;
  };

  double force_on(std::size_t entry) const {
    return dot(last_.result.contact[entry].total.force, MovingContact::direction(model_.contact[entry]));
  }

  /// Whether a next solve can start from the last one: its residuals meet the tolerance, or are rounding.
  bool settled() const {
    const Result& result = last_.result;
    return result.status == Status::converged || (result.status == Status::limited_by_rounding &&
                                                  result.certificate.exhausted(model_.solver.tolerance));
  }

  /// One obstacle after the other, until all have their forces at once (theory: force-control). Whether they
  /// have, and the last solve is settled.
  bool push_all(const std::vector<double>& factors) {
    constexpr int most_rounds = 100;
    for (Pushed& pushed : pushed_) begin(pushed, factors[pushed.entry]);
    std::vector<Pushed*> acting;
    for (Pushed& pushed : pushed_)
      if (pushed.search.force > 0.0) acting.push_back(&pushed);
    pushes_ = !acting.empty();
    if (!pushes_) {
      solve_once();
      return settled();
    }
    bool going = true, all_have = false;
    for (int round = 0; going && round < most_rounds; ++round) {
      for (Pushed* pushed : acting) going = going && push(*pushed);
      all_have = going && std::all_of(acting.begin(), acting.end(), [&](const Pushed* pushed) {
                   return pushed->search.meets(force_on(pushed->entry));
                 });
      going = going && !all_have;
    }
    for (const Pushed* pushed : acting) last_.result.contact[pushed->entry].travel = pushed->search.travel;
    if (!going) return all_have;
    last_.result.status = Status::not_converged;
    last_.result.message = "the obstacles that are pushed act on each other, and after " +
                           std::to_string(most_rounds) + " rounds have not all the forces that are asked for";
    return false;
  }

  /// Puts it where its search begins.
  void begin(Pushed& pushed, double factor) {
    const ContactEntry& entry = model_.contact[pushed.entry];
    PushedObstacle& search = pushed.search;
    search.force = entry.force_controlled->force * factor;
    search.tolerance = std::min(10.0 * model_.solver.tolerance, 0.1);
    search.touch = contact_.touch(pushed.entry);
    // Not there yet, or no longer.
    if (search.force <= 0.0) return contact_.withdraw(pushed.entry);
    search.scale = search.force / part_.laws[0].secant(0.0);
    search.scale /= part_.dim() == 3 || part_.plane == PlaneState::axisymmetric ? extent_ : part_.thickness;
    if (!std::isfinite(search.travel)) search.travel = search.touch + search.scale;
    contact_.push(pushed.entry, search.travel);
  }

  /// Solves for the travel of an obstacle that makes its force the one that is asked for. Whether that is
  /// found.
  bool push(Pushed& pushed) {
    const PushOutcome outcome = find_travel(pushed.search, [&](double travel) -> std::optional<double> {
      contact_.push(pushed.entry, travel);
      PlainText place;
      place << entry_name(model_.contact[pushed.entry], pushed.entry) << " pushed by " << travel;
      tell(place.str());
      solve_once();
      if (!settled()) return std::nullopt;
      return force_on(pushed.entry);
    });
    pushed.search.travel = outcome.travel;
    if (outcome.reached) return true;
    PlainText text;
    text << "the obstacle of " << entry_name(model_.contact[pushed.entry], pushed.entry) << " is pushed by "
         << pushed.search.force << ", and ";
    const bool stopped = !settled();
    text << (stopped ? "the search for its travel has stopped; at "
                     : "no travel is found at which the body bears that; at ")
         << outcome.travel << " it bears " << force_on(pushed.entry);
    if (stopped) text << ": " << last_.result.message;
    if (!stopped) last_.result.status = Status::not_converged;
    last_.result.message = text.str();
    return false;
  }

  void end_early(std::size_t step, double time) {
    const bool moves = std::any_of(model_.contact.begin(), model_.contact.end(),
                                   [](const ContactEntry& entry) { return entry.motion.has_value(); });
    if (moves && last_.result.load_factor != time) {
      PlainText place;
      place << "; obstacles with a motion are where they are at " << time;
      last_.result.message += place.str();
    }
    if (curves_.size() == 2) return;
    last_.result.message = load_step_name(step - 1, curves_.size() - 1, !model_.steps_are_factors, time) +
                           ": " + last_.result.message;
  }

  Part& part_;
  const Model& model_;
  RunOptions run_;
  MovingContact contact_;
  std::vector<LoadFactors> curves_;
  double extent_;  ///< of the body
  std::vector<Pushed> pushed_;
  bool pushes_ = false;    ///< some of them in this load step
  std::vector<double> u_;  ///< at the end of the load step before
  Start start_;
  decltype(RunOptions::load_step_over) over_;
  Solution last_;  ///< its counts, times and warnings are those of all solves so far
};

}  // namespace

Model with_curves(Model model) {
  if (!any_moves(model) || !model.steps.empty()) return model;
  std::vector<double> shares = std::move(model.solver.load_steps);
  if (shares.empty()) shares = {1.0};
  model.solver.load_steps.clear();
  model.steps_are_factors = true;
  for (const double share : shares) {
    LoadStage stage{share, {}};
    for (std::size_t i = 0; i < model.boundary.size(); ++i)
      if (!model.boundary[i].is_spring()) stage.factors[entry_name(model.boundary[i], i)] = share;
    for (std::size_t i = 0; i < model.contact.size(); ++i)
      if (!model.contact[i].motion && (!model.contact[i].relinearise || model.contact[i].force_controlled))
        stage.factors[entry_name(model.contact[i], i)] = share;
    model.steps.push_back(stage);
  }
  return model;
}

Solution solve_moving(Part& part, const Model& model, RunOptions run) {
  if (part.steps.size() < 2) throw InternalError("moving obstacles without load curves");
  return Chain(part, model, run).run();
}

}  // namespace kacanov
