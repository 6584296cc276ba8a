// SPDX-License-Identifier: BSD-3-Clause
// What decides how the outer loop goes on: the linearisation, the penalty, the fallback, and whether the
// contact changes yet.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/model.hpp>
#include "contact/admm.hpp"
#include "contact/certificate.hpp"
#include "contact/contact_state.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// For whoever has to say why a run does not converge. It steers nothing, and no checkpoint has it.
class ContactChanges {
 public:
  static constexpr int window = 16;  ///< outer steps that are looked back on

  /// After an outer step.
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

  /// In how many of the last steps a point was another than in the step before.
  int count(std::size_t point) const { return point < changed_.size() ? std::popcount(changed_[point]) : 0; }

 private:
  enum : std::uint8_t { open, sticks, slips };
  std::vector<std::uint8_t> now_;
  std::vector<std::uint16_t> changed_;  ///< a bit a step

  static std::uint8_t state_of(const ContactPoint& point, const ContactState& state, std::size_t i) {
    if (point.tangents == 0 || state.bound[i] == 0.0) return state.lambda.normal[i] > 0.0 ? slips : open;
    const double* friction = &state.lambda.tangential[2 * i];
    // The projection leaves |λ_t| = ψ to rounding; a Coulomb's ψ has moved on since.
    constexpr double at_bound = 1.0 - 1e-10;
    return std::hypot(friction[0], friction[1]) >= at_bound * state.bound[i] ? slips : sticks;
  }
};

/// Tells a stall of semismooth Newton steps, then asks for ADMM steps: a number that doubles with every
/// retreat, fewer where they reach a tenth of the best residual before (theory: active-set).
class Fallback {
 public:
  explicit Fallback(const Tuning& tuning) : tuning_(tuning) {}

  /// Whether ADMM is to take the next step.
  bool retreating() const noexcept { return steps_left_ > 0; }
  /// `worst`: largest KKT residual after the step; `solved`: its linear problems were.
  void after_admm(double worst, bool solved = true);
  /// The same for a Newton step; `solved`: its linear problem was. Whether a retreat begins.
  bool after_newton(double worst, bool solved);
  /// Whether nothing has been gained for so long that nothing is to be hoped for.
  bool stuck() const noexcept { return idle_ >= tuning_.most_idle; }
  void start_again() { *this = Fallback(tuning_); }

  /// Entries of a checkpoint.
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
  int steps_left_ = 0;      ///< ADMM steps still to take
  double aim_ = 0.0;        ///< residual at which they end early
  int retreats_ = 0;
  double lowest_ = HUGE_VAL;  ///< residual that counts as the last gain
  int idle_ = 0;              ///< steps since
  void count(double worst);
};

/// Penalty to begin with, from 1/λ_min of the normal rows, how many contact nodes there are in all and the
/// dimension (theory: first-penalty); 1 where nothing is known.
double first_penalty(double lambda_min, std::int64_t nodes, int dim, const Tuning& tuning);

/// One penalty for N, one for T. Balanced after ADMM steps where the rule is automatic, else left alone.
class PenaltyControl {
 public:
  /// `first`: what an automatic rule begins with.
  PenaltyControl(const SolverOptions& options, double first, const Tuning& tuning);

  const Penalty& value() const noexcept { return value_; }
  /// Whether there is one to work with.
  bool chosen() const noexcept { return value_.normal > 0.0; }
  /// r of the user, or the first one; with Penalty::paper r* (theory: r-star). `lambda_min` bounds what
  /// balancing may do; 0: it does nothing.
  void choose(double r_star, double lambda_min);
  /// From a checkpoint.
  void restore(const Penalty& value, double lambda_min);

  /// Raises the penalty of held rows that are behind the free ones and lowers it where those are (theory:
  /// balance). Whether the rule moves them at all.
  bool balance(std::span<const BalanceSample> samples, const Scales& scales);
  /// To be called instead for the step that brought the first contact, after others without any: while
  /// nothing touches, the balance sees motion alone and lowers the penalties further than contact wants them
  /// (42 iterations instead of 55, 52 instead of 57 on half balls 0.3 away).
  bool go_back_to_first();

 private:
  bool moves() const noexcept { return automatic_ && lambda_min_ > 0.0; }

  Tuning tuning_;
  bool automatic_;  ///< the rule, and the stop does not judge by steps
  SolverOptions::Penalty rule_;
  double r_, first_;
  Penalty value_;
  double lambda_min_ = 0.0;
};

/// Which linearisation a semismooth Newton step takes (theory: newton): the secant while equilibrium is far
/// off, then the tangent. Where a tangent has gone too far it is trusted less.
class Linearisation {
 public:
  /// `linear`: the body has no other law; there is nothing to choose.
  Linearisation(SolverOptions::Outer outer, bool linear, const Tuning& tuning)
      : outer_(outer), linear_(linear), tuning_(tuning), reach_(tuning.first_reach) {}

  /// For a step from a state with this residual of equilibrium.
  bool takes_tangent(double equilibrium) const;
  /// Learns from a tangent step: the residual of equilibrium before and after (NaN: after a breakdown), and
  /// how much of it was taken.
  void after_tangent(double before, double after, double length = 1.0);
  void after_secant() noexcept { cut_short_ = false; }
  /// Forgets what it has learnt, for another load.
  void start_again() {
    reach_ = tuning_.first_reach;
    cut_short_ = false;
  }

  double reach() const noexcept { return reach_; }
  /// Entries of a checkpoint.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("reach", reach_);
    entry("cut_short", cut_short_);
  }

 private:
  SolverOptions::Outer outer_;
  bool linear_;
  Tuning tuning_;
  bool cut_short_ = false;  ///< the last tangent step was: the next takes the secant
  double reach_;            ///< residual of equilibrium up to which steps take the tangent
};

/// Whether a step of length `t` along δ is too long, and what to try instead; nothing if it may stay (theory:
/// damping). `work`: δ·(R(u + tδ) − R(u)), what the true force has grown by; `curvature`: δ·B δ of the linear
/// model.
std::optional<double> shorter_step(double t, double work, double curvature);

}  // namespace kacanov
