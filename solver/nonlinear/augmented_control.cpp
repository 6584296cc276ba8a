// SPDX-License-Identifier: BSD-3-Clause
// Penalty and multiplier updates of the method of multipliers.
#include "nonlinear/augmented_control.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace kacanov {
namespace {

Vector joined(const ContactValues& values) {
  Vector all = values.normal;
  all.insert(all.end(), values.tangential.begin(), values.tangential.end());
  return all;
}

Vector difference(const Vector& a, const Vector& b) {
  Vector d(a);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] -= b[i];
  return d;
}

/// Returns Σ M a·b over this rank's own points.
double product(const Traces& traces, const Vector& a, const Vector& b) {
  const std::size_t n = traces.size();
  double sum = 0.0;
  for (std::size_t i = 0; i < traces.owned(); ++i)
    sum += traces.points()[i].mass *
           (a[i] * b[i] + a[n + 2 * i] * b[n + 2 * i] + a[n + 2 * i + 1] * b[n + 2 * i + 1]);
  return sum;
}

/// Stores multipliers in the state: clips negative pressures, and friction beyond the bounds of these
/// pressures.
void put(const Traces& traces, const Vector& all, ContactState& state) {
  const std::size_t n = traces.size();
  for (std::size_t i = 0; i < n; ++i) {
    const ContactPoint& point = traces.points()[i];
    const double pressure = state.lambda.normal[i] = std::max(all[i], 0.0);
    state.bound[i] = point.friction_bound(pressure);
    const double length = std::hypot(all[n + 2 * i], all[n + 2 * i + 1]);
    const double share = length > state.bound[i] ? state.bound[i] / length : 1.0;
    for (std::size_t k = 0; k < 2; ++k) state.lambda.tangential[2 * i + k] = share * all[n + 2 * i + k];
  }
}

}  // namespace

void AugmentedControl::begin(double penalty, double lambda_min) {
  penalty_ = penalty > 0.0 ? penalty : 1.0;
  most_ = lambda_min > 0.0 ? tuning_.augmented_penalty / lambda_min : penalty_;
  rounds_ = 0;
  changes_.clear();
}

void AugmentedControl::advance(const Traces& traces, ContactState& state) {
  Round now{{}, joined(state.lambda)};
  Vector next = now.image;
  if (rounds_ > 0) {
    now.rest = difference(now.image, from_);
    const double size = traces.ranks().sum_all(product(traces, now.rest, now.rest));
    if (rounds_ > 1) {
      changes_.push_front({difference(now.rest, last_.rest), difference(now.image, last_.image)});
      // After such a change the map itself has changed: other points touch or slip.
      if (size > 4.0 * last_size_) changes_.clear();
      if (changes_.size() > static_cast<std::size_t>(tuning_.augmented_memory)) changes_.pop_back();
    }
    next = mixed(traces, now);
    last_ = std::move(now);
    last_size_ = size;
  }
  put(traces, next, state);
  from_ = joined(state.lambda);
  ++rounds_;
}

Vector AugmentedControl::mixed(const Traces& traces, const Round& now) const {
  Vector next = now.image;
  if (changes_.empty()) {
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = from_[i] + tuning_.augmented_following * now.rest[i];
    return next;
  }
  const auto m = static_cast<Eigen::Index>(changes_.size());
  Vector sums;
  for (const Round& a : changes_) {
    for (const Round& b : changes_) sums.push_back(product(traces, a.rest, b.rest));
    sums.push_back(product(traces, a.rest, now.rest));
  }
  traces.ranks().sum_all(sums);
  const Eigen::Map<const Eigen::MatrixXd> all(sums.data(), m + 1, m);  // one column per difference
  const Eigen::VectorXd scale = all.topRows(m).diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd gram = scale.asDiagonal() * all.topRows(m) * scale.asDiagonal();
  gram.diagonal().array() += 1e-10;  // regularises linearly dependent differences
  const Eigen::VectorXd right = scale.cwiseProduct(all.row(m).transpose());
  const Eigen::VectorXd share = scale.cwiseProduct(gram.ldlt().solve(right));
  for (Eigen::Index k = 0; k < m; ++k)
    for (std::size_t i = 0; i < next.size(); ++i) next[i] -= share(k) * changes_[k].image[i];
  return next;
}

void AugmentedControl::learn(int iterations) {
  if (iterations <= tuning_.augmented_few) penalty_ = std::min(most_, tuning_.augmented_change * penalty_);
  if (iterations >= tuning_.augmented_many) penalty_ /= tuning_.augmented_change;
}

}  // namespace kacanov
