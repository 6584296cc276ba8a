// SPDX-License-Identifier: BSD-3-Clause
// Solving where obstacles move, are pushed by a force, or are faced anew at each load step.
#include <kacanov/moving.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include "moving_contact.hpp"
#include "parallel/body_extent.hpp"
#include "pushed_obstacle.hpp"

namespace kacanov {
namespace {

/// Adds up what a run is made of, solve by solve.
class Chain {
 public:
  Chain(Part& part, const Model& model, const RunOptions& run)
      : part_(part), model_(model), run_(run), contact_(part, model), curves_(part.steps) {
    run_.checkpoint = nullptr;
    run_.start = nullptr;
    if (run_.coarse != nullptr) start_ = interpolate(*run_.coarse, part);
    run_.coarse = nullptr;
    u_.assign(part.unknowns(), 0.0);
  }

  Solution run() {
    for (std::size_t k = 1; k < curves_.size(); ++k) {
      const double time = curves_[k].time;
      // Between the two the load is cut, where that has to be.
      part_.steps = {still(curves_[k - 1]), still(curves_[k])};
      part_.steps[0].time = 0.0;
      contact_.face(time, curves_[k - 1].time, u_);
      const int before = outer_;
      const std::int64_t cg = cg_;
      push_all(curves_[k]);
      u_ = last_.displacement;
      const Result& result = last_.result;
      if (!result.load_steps.empty()) {
        LoadStep line = result.load_steps.back();
        line.outer_iterations = outer_ - before;
        line.cg_iterations = cg_ - cg;
        lines_.push_back(line);
      }
      if (result.status == Status::converged || result.load_reached > 0.0) reached_ = result.load_reached;
      if (result.status != Status::converged) {
        end_early(k, time);
        break;
      }
    }
    return finish();
  }

 private:
  /// Factors, but that obstacles which move are not drawn back by theirs.
  LoadFactors still(LoadFactors factors) const {
    for (std::size_t e = 0; e < factors.contact.size(); ++e)
      if (model_.contact[e].moves()) factors.contact[e] = 1.0;
    return factors;
  }

  void solve_once() {
    run_.from = start_.displacement.empty() ? nullptr : &start_;
    last_ = solve(part_, model_.solver, run_);
    Result& result = last_.result;
    outer_ += result.outer_iterations;
    cg_ += result.cg_iterations;
    contact_iterations_ += result.contact_iterations;
    unsolved_ += result.unsolved_steps;
    cuts_ += result.load_cuts;
    applications_ += result.operator_applications;
    spectrum_applications_ += result.spectrum_applications;
    contact_applications_ += result.contact_applications;
    penalties_.insert(penalties_.end(), result.r.begin(), result.r.end());
    for (double PhaseSeconds::*phase : {&PhaseSeconds::total, &PhaseSeconds::prepare, &PhaseSeconds::spectrum,
                                        &PhaseSeconds::preconditioner_setup, &PhaseSeconds::solve,
                                        &PhaseSeconds::checkpoint, &PhaseSeconds::certificate})
      seconds_.*phase += result.seconds.*phase;
    for (const std::string& warning : result.warnings)
      if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end())
        warnings_.push_back(warning);
    start_.displacement = last_.displacement;
    start_.pressure = last_.pressure;
    start_.friction.assign(2 * part_.contact.size(), 0.0);
    for (std::size_t i = 0; i < part_.contact.size(); ++i)
      for (int k = 0; k < part_.contact[i].tangents; ++k)
        for (std::size_t c = 0; c < 3; ++c)
          start_.friction[2 * i + static_cast<std::size_t>(k)] -=
              last_.traction[i][c] * part_.contact[i].tangent[k][c];
    start_.lambda_max = result.lambda_max;
  }

  /// Solves; with an obstacle that is pushed, for the travel that makes its force the one that is asked for.
  void push_all(const LoadFactors& factors) {
    for (std::size_t e = 0; e < model_.contact.size(); ++e) {
      const ContactEntry& entry = model_.contact[e];
      if (!entry.force_controlled) continue;
      const Vector3 d = MovingContact::direction(entry);
      PushedObstacle pushed;
      pushed.force = entry.force_controlled->force * factors.contact[e];
      pushed.tolerance = std::min(10.0 * model_.solver.tolerance, 0.1);
      pushed.touch = contact_.touch(e);
      if (pushed.force <= 0.0) {  // not there yet, or no longer
        contact_.push(e, pushed.touch - body_extent(part_));
        break;
      }
      pushed.travel = travelled_ ? travel_ : HUGE_VAL;
      pushed.scale = pushed.force / part_.laws[0].secant(0.0);
      if (part_.dim() == 3) pushed.scale /= body_extent(part_);
      const PushOutcome outcome = find_travel(pushed, [&](double travel) -> std::optional<double> {
        contact_.push(e, travel);
        solve_once();
        if (last_.result.status != Status::converged) return std::nullopt;
        const Vector3& force = last_.result.contact[e].total.force;
        return force[0] * d[0] + force[1] * d[1] + force[2] * d[2];
      });
      travelled_ = true;
      travel_ = outcome.travel;
      last_.result.contact[e].travel = travel_;
      if (outcome.reached || last_.result.status != Status::converged) return;
      last_.result.status = Status::not_converged;
      std::ostringstream text;
      text << "the obstacle of " << entry_name(entry, e) << " is pushed by " << pushed.force
           << ", and no travel is found at which the body bears that; at " << outcome.travel << " it bears "
           << outcome.force;
      last_.result.message = text.str();
      return;
    }
    solve_once();
  }

  void end_early(std::size_t step, double time) {
    if (curves_.size() == 2) return;
    std::ostringstream place;
    place << "load step " << step << " of " << curves_.size() - 1 << " (time " << time << "): ";
    last_.result.message = place.str() + last_.result.message;
  }

  Solution finish() {
    Result& result = last_.result;
    result.outer_iterations = outer_;
    result.cg_iterations = cg_;
    result.contact_iterations = contact_iterations_;
    result.unsolved_steps = unsolved_;
    result.load_cuts = cuts_;
    result.operator_applications = applications_;
    result.spectrum_applications = spectrum_applications_;
    result.contact_applications = contact_applications_;
    result.r = penalties_;
    result.seconds = seconds_;
    result.warnings = warnings_;
    result.load_steps = lines_;
    result.load_reached = reached_;
    return std::move(last_);
  }

  Part& part_;
  const Model& model_;
  RunOptions run_;
  MovingContact contact_;
  std::vector<LoadFactors> curves_;
  std::vector<double> u_;
  Start start_;
  Solution last_;
  bool travelled_ = false;
  double travel_ = 0.0, reached_ = 0.0;
  int outer_ = 0, unsolved_ = 0, cuts_ = 0;
  std::int64_t cg_ = 0, contact_iterations_ = 0;
  std::uint64_t applications_ = 0, spectrum_applications_ = 0, contact_applications_ = 0;
  std::vector<double> penalties_;
  std::vector<std::string> warnings_;
  std::vector<LoadStep> lines_;
  PhaseSeconds seconds_;
};

}  // namespace

bool any_moves(const Model& model) {
  return std::any_of(model.contact.begin(), model.contact.end(),
                     [](const auto& entry) { return entry.moves(); });
}

Model with_curves(Model model) {
  if (!any_moves(model) || !model.steps.empty()) return model;
  std::vector<double> shares = std::move(model.solver.load_steps);
  if (shares.empty()) shares = {1.0};
  model.solver.load_steps.clear();
  for (const double share : shares) {
    LoadStage stage{share, {}};
    for (std::size_t i = 0; i < model.boundary.size(); ++i)
      stage.factors[entry_name(model.boundary[i], i)] = share;
    for (std::size_t i = 0; i < model.contact.size(); ++i)
      if (!model.contact[i].motion && !model.contact[i].relinearise)
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
