// SPDX-License-Identifier: BSD-3-Clause
// Controls of the outer loop: linearisation, penalty, fallback, and a record of contact changes.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/model.hpp>
#include "contact/admm.hpp"
#include "contact/certificate.hpp"
#include "contact/contact_state.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// Contact changes of recent steps, for the convergence diagnosis only; they do not affect the loop and are
/// not in checkpoints.
class ContactChanges {
 public:
  static constexpr int window = 16;  ///< outer steps covered

  /// Records the state after an outer step.
  void note(std::span<const ContactPoint> points, const ContactState& state) {
    const bool known = !now_.empty();
    now_.resize(points.size());
    changed_.resize(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint8_t next = state_of(points[i], state, i);
      changed_[i] = static_cast<std::uint16_t>(changed_[i] << 1 | (known && next != now_[i] ? 1 : 0));
      now_[i] = next;
    }
  }
  void start_again() {
    now_.clear();
    changed_.clear();
  }

  /// Returns in how many of the last steps the state of a point changed.
  int count(std::size_t point) const { return point < changed_.size() ? std::popcount(changed_[point]) : 0; }

 private:
  enum : std::uint8_t { open, sticks, slips };
  std::vector<std::uint8_t> now_;
  std::vector<std::uint16_t> changed_;  ///< one bit per step

  static std::uint8_t state_of(const ContactPoint& point, const ContactState& state, std::size_t i) {
    if (point.tangents == 0 || state.bound[i] == 0.0) return state.lambda.normal[i] > 0.0 ? slips : open;
    const double* friction = &state.lambda.tangential[2 * i];
    // The projection gives |λ_t| = ψ up to rounding, but Coulomb's ψ has been updated since.
    constexpr double at_bound = 1.0 - 1e-10;
    return std::hypot(friction[0], friction[1]) >= at_bound * state.bound[i] ? slips : sticks;
  }
};

/// Detects stagnation of semismooth Newton steps, and then requests steps of the method of multipliers (a
/// retreat): their number doubles with every retreat, and a retreat ends early at a tenth of the best
/// residual before it (theory: active-set, augmented-newton).
class Fallback {
 public:
  explicit Fallback(const Tuning& tuning) : tuning_(tuning) {}

  /// Whether the method of multipliers takes the next step.
  bool retreating() const noexcept { return steps_left_ > 0; }
  /// `worst`: largest KKT residual after the step; `solved`: whether its linear problems were solved.
  void after_fallback_step(double worst, bool solved = true);
  /// The same for a Newton step. Returns whether a retreat begins.
  bool after_newton(double worst, bool solved);
  /// Whether there has been no progress for so long that the loop should stop.
  bool stuck() const noexcept { return idle_ >= tuning_.most_idle; }
  void start_again() { *this = Fallback(tuning_); }

  /// Visits the entries of a checkpoint.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("best", best_);
    entry("stalled", stalled_);
    entry("retreat", steps_left_);
    entry("aim", aim_);
    entry("retreats", retreats_);
    entry("lowest", lowest_);
    entry("idle", idle_);
  }

 private:
  Tuning tuning_;
  double best_ = HUGE_VAL;  ///< smallest residual since the last retreat
  int stalled_ = 0;         ///< Newton steps without a new best residual
  int steps_left_ = 0;      ///< remaining steps of the retreat
  double aim_ = 0.0;        ///< residual at which they end early
  int retreats_ = 0;
  double lowest_ = HUGE_VAL;  ///< residual at the last significant gain
  int idle_ = 0;              ///< steps since then
  void count(double worst);
};

/// Returns the initial penalty from λ_min of the normal rows, the total number of contact nodes and the
/// dimension (theory: first-penalty); 1 if λ_min is unknown.
double first_penalty(double lambda_min, std::int64_t nodes, int dim, const Tuning& tuning);

/// Penalties for N and T. With an automatic rule, balanced after ADMM steps; otherwise constant.
class PenaltyControl {
 public:
  /// `first`: initial value of an automatic rule.
  PenaltyControl(const SolverOptions& options, double first, const Tuning& tuning);

  const Penalty& value() const noexcept { return value_; }
  /// Whether a penalty has been chosen.
  bool chosen() const noexcept { return value_.normal > 0.0; }
  /// Sets the user's r, or the first one, or with Penalty::paper r* (theory: r-star). `lambda_min` limits the
  /// balancing; 0 disables it.
  void choose(double r_star, double lambda_min);
  /// Restores the values of a checkpoint.
  void restore(const Penalty& value, double lambda_min);

  /// Raises the penalty where held rows lag behind free ones, and lowers it in the opposite case (theory:
  /// balance). Returns whether the rule changes penalties at all.
  bool balance(std::span<const BalanceSample> samples, const Scales& scales);
  /// Whether a published rule takes the place of the balance.
  bool has_rule() const noexcept { return published_; }
  /// Moves both penalties by that rule. Collective.
  void follow_rule(const PenaltyEvidence& evidence, const Traces& traces);
  /// Call it instead after the step that brought the first contact, if others without any came before:
  /// without contact, balancing sees only motion and lowers the penalties too far (42 iterations instead of
  /// 55, 52 instead of 57 on half balls 0.3 away).
  bool go_back_to_first();

 private:
  bool moves() const noexcept { return automatic_ && lambda_min_ > 0.0; }

  Tuning tuning_;
  bool automatic_;  ///< the rule is automatic, and the stop is not by steps
  SolverOptions::Penalty rule_;
  double r_, first_;
  Penalty value_;
  double lambda_min_ = 0.0;
  bool published_;  ///< a published rule is chosen, and the stop is not by steps
  /// Of the last step, for that rule; not in checkpoints.
  std::shared_ptr<const PenaltyEvidence> evidence_;
};

/// Chooses the linearisation of semismooth Newton steps (theory: newton): the secant far from equilibrium,
/// then the tangent. After an overshoot the tangent is used closer to equilibrium only.
class Linearisation {
 public:
  /// `linear`: all laws of the body are linear, so there is no choice.
  Linearisation(SolverOptions::Outer outer, bool linear, const Tuning& tuning)
      : outer_(outer), linear_(linear), tuning_(tuning), reach_(tuning.first_reach) {}

  /// Whether a step from a state with this equilibrium residual uses the tangent.
  bool takes_tangent(double equilibrium) const;
  /// Records a tangent step: equilibrium residual before and after (NaN: breakdown), and the accepted step
  /// length.
  void after_tangent(double before, double after, double length = 1.0);
  void after_secant() noexcept { cut_short_ = false; }
  /// Resets to the initial state, for another load.
  void start_again() {
    reach_ = tuning_.first_reach;
    cut_short_ = false;
  }

  double reach() const noexcept { return reach_; }
  /// Visits the entries of a checkpoint.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("reach", reach_);
    entry("cut_short", cut_short_);
  }

 private:
  SolverOptions::Outer outer_;
  bool linear_;
  Tuning tuning_;
  bool cut_short_ = false;  ///< whether the last tangent step was shortened: the next step uses the secant
  double reach_;            ///< equilibrium residual up to which steps use the tangent
};

/// Returns a shorter length if a step of length `t` along δ is too long, else nothing (theory: damping).
/// `work`: δ·(R(u + tδ) − R(u)), the work of the force change; `curvature`: δ·B δ of the linear model.
std::optional<double> shorter_step(double t, double work, double curvature);

}  // namespace kacanov
