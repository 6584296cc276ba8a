// SPDX-License-Identifier: BSD-3-Clause
// Controls of the outer loop: linearisation, penalty, fallback.
#include "nonlinear/loop_control.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

void Fallback::count(double worst) {
  ++idle_;
  if (!(worst < tuning_.gain * lowest_)) return;
  lowest_ = worst;
  idle_ = 0;
}

void Fallback::after_fallback_step(double worst, bool solved) {
  count(worst);
  if (!solved && idle_ > 0) idle_ += tuning_.unsolved_worth - 1;
  steps_left_ = worst <= aim_ ? 0 : std::max(0, steps_left_ - 1);
}

bool Fallback::after_newton(double worst, bool solved) {
  count(worst);
  stalled_ = worst < tuning_.progress * best_ ? 0 : stalled_ + 1;
  best_ = std::min(best_, worst);
  if (solved && stalled_ < tuning_.patience && std::isfinite(worst)) return false;
  // The method of multipliers converges from any state; every retreat is longer than the last.
  stalled_ = 0;
  aim_ = std::isfinite(best_) ? tuning_.retreat_gain * best_ : 0.0;
  best_ = HUGE_VAL;
  steps_left_ = tuning_.first_retreat << std::min(retreats_++, tuning_.most_doublings);
  return true;
}

double first_penalty(double lambda_min, std::int64_t nodes, int dim, const Tuning& tuning) {
  // λ_max(K_I|A), the compliance of the part that lifts off, relates to λ_min as its size to the mesh width;
  // so r_A scales as 1/λ_min times the root of the relative mesh width.
  const double width = std::pow(static_cast<double>(nodes), -1.0 / (dim - 1));
  return lambda_min > 0.0 ? tuning.first_penalty * std::sqrt(width) / lambda_min : 1.0;
}

PenaltyControl::PenaltyControl(const SolverOptions& options, double first, const Tuning& tuning)
    : tuning_(tuning),
      automatic_(options.penalty == SolverOptions::Penalty::automatic &&
                 options.stop != SolverOptions::Stop::paper),
      rule_(options.penalty),
      r_(options.r),
      first_(adapts(options.penalty) && options.r > 0.0 ? options.r : first),
      published_(follows_rule(options.penalty) && options.stop != SolverOptions::Stop::paper) {}

void PenaltyControl::choose(double r_star, double lambda_min) {
  const double r = adapts(rule_) ? first_ : rule_ == SolverOptions::Penalty::paper ? r_star : r_;
  restore({r, r}, lambda_min);
}

void PenaltyControl::restore(const Penalty& value, double lambda_min) {
  value_ = value;
  lambda_min_ = lambda_min;
}

bool PenaltyControl::balance(std::span<const BalanceSample> samples, const Scales& scales) {
  if (!moves()) return false;
  const double largest = tuning_.largest_penalty / lambda_min_;
  // A step with few iterations is weak evidence.
  const double trust = std::min(1.0, static_cast<double>(samples.size()) / tuning_.trusted_iterations);
  const auto balanced = [&](double r, double behind) {
    const double factor = std::exp(std::clamp(0.5 * trust * behind, -1.0, 1.0));
    return std::clamp(r * factor, tuning_.smallest_share * largest, largest);
  };
  const auto behind = mean_behind(samples, scales.trace, scales.contact_force);
  value_ = {balanced(value_.normal, behind[0]), balanced(value_.tangential, behind[1])};
  return true;
}

void PenaltyControl::follow_rule(const PenaltyEvidence& evidence, const Traces& traces) {
  const double r = next_penalty(rule_, value_.normal, evidence, evidence_.get(), traces);
  value_ = {r, r};
  evidence_ = std::make_shared<PenaltyEvidence>(evidence);
}

bool PenaltyControl::go_back_to_first() {
  if (!moves()) return false;
  value_ = {first_, first_};
  return true;
}

bool Linearisation::takes_tangent(double equilibrium) const {
  const bool far = outer_ == SolverOptions::Outer::automatic && (equilibrium > reach_ || cut_short_);
  return outer_ != SolverOptions::Outer::kacanov && !linear_ && !far;
}

void Linearisation::after_tangent(double before, double after, double length) {
  cut_short_ = length < tuning_.short_step;
  if (!(after <= before)) reach_ = std::max(tuning_.least_reach, tuning_.reach_cut * before);
}

std::optional<double> shorter_step(double t, double work, double curvature) {
  // Along δ the energy of the linear model has the slope −q (1 − t). A step is too long if the true force
  // exceeds the model's by more than half of q (unloading is stiffer than the tangent).
  if (!std::isfinite(work)) return t * 0.1;
  if (work <= 1.5 * curvature) return std::nullopt;
  return t * std::clamp(curvature / work, 0.1, 0.7);
}

}  // namespace kacanov
