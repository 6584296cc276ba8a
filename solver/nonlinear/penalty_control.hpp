// SPDX-License-Identifier: BSD-3-Clause
// The penalties of ADMM: the first ones, and how they follow what each step shows.
#pragma once

#include <cstdint>
#include <span>

#include "contact/admm.hpp"
#include "contact/certificate.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

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

}  // namespace kacanov
