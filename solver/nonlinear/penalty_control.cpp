// SPDX-License-Identifier: BSD-3-Clause
// The penalties of ADMM: the first ones, and how they follow what each step shows.
#include "nonlinear/penalty_control.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

double first_penalty(double lambda_min, std::int64_t nodes, int dim, const Tuning& tuning) {
  // λ_max(K_I|A), the compliance of the part that lifts off, is to λ_min as its size to the mesh width: r_A
  // goes with 1/λ_min and the root of that.
  const double width = std::pow(static_cast<double>(nodes), -1.0 / (dim - 1));
  return lambda_min > 0.0 ? tuning.first_penalty * std::sqrt(width) / lambda_min : 1.0;
}

PenaltyControl::PenaltyControl(const SolverOptions& options, double first, const Tuning& tuning)
    : tuning_(tuning),
      automatic_(options.penalty == SolverOptions::Penalty::automatic &&
                 options.stop != SolverOptions::Stop::paper),
      rule_(options.penalty),
      r_(options.r),
      first_(first) {}

void PenaltyControl::choose(double r_star, double lambda_min) {
  const double r = rule_ == SolverOptions::Penalty::paper       ? r_star
                   : rule_ == SolverOptions::Penalty::automatic ? first_
                                                                : r_;
  restore({r, r}, lambda_min);
}

void PenaltyControl::restore(const Penalty& value, double lambda_min) {
  value_ = value;
  lambda_min_ = lambda_min;
}

bool PenaltyControl::balance(std::span<const BalanceSample> samples, const Scales& scales) {
  if (!moves()) return false;
  const double largest = tuning_.largest_penalty / lambda_min_;
  // A step of few iterations says little.
  const double trust = std::min(1.0, static_cast<double>(samples.size()) / tuning_.trusted_iterations);
  const auto balanced = [&](double r, double behind) {
    const double factor = std::exp(std::clamp(0.5 * trust * behind, -1.0, 1.0));
    return std::clamp(r * factor, tuning_.smallest_share * largest, largest);
  };
  const auto behind = mean_behind(samples, scales.trace, scales.contact_force);
  value_ = {balanced(value_.normal, behind[0]), balanced(value_.tangential, behind[1])};
  return true;
}

bool PenaltyControl::go_back_to_first() {
  if (!moves()) return false;
  value_ = {first_, first_};
  return true;
}

}  // namespace kacanov
