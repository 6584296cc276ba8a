// SPDX-License-Identifier: BSD-3-Clause
// Penalty and multipliers of the method of multipliers, from one of its rounds to the next.
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

/// Σ M a·b of this rank's own points.
double product(const Traces& traces, const Vector& a, const Vector& b) {
  const std::size_t n = traces.size();
  double sum = 0.0;
  for (std::size_t i = 0; i < traces.owned(); ++i)
    sum += traces.points()[i].mass *
           (a[i] * b[i] + a[n + 2 * i] * b[n + 2 * i] + a[n + 2 * i + 1] * b[n + 2 * i + 1]);
  return sum;
}

/// Pressures that are none, and friction beyond what they allow, are cut; bounds go with the pressure.
void put(const Traces& traces, const Vector& all, ContactState& state) {
  const std::size_t n = traces.size();
  for (std::size_t i = 0; i < n; ++i) {
    const ContactPoint& point = traces.points()[i];
    const double pressure = state.lambda.normal[i] = std::max(all[i], 0.0);
    state.bound[i] = point.tresca + point.coulomb * pressure;
    const double length = std::hypot(all[n + 2 * i], all[n + 2 * i + 1]);
    const double share = length > state.bound[i] ? state.bound[i] / length : 1.0;
    for (std::size_t k = 0; k < 2; ++k) state.lambda.tangential[2 * i + k] = share * all[n + 2 * i + k];
  }
}

}  // namespace

void AugmentedControl::begin(double penalty, double lambda_min) {
  penalty_ = penalty > 0.0 ? penalty : 1.0;
  most_ = lambda_min > 0.0 ? tuning_.augmented_penalty / lambda_min : penalty_;
  from_.clear();
  last_rest_.clear();
  changes_.clear();
}

void AugmentedControl::advance(const Traces& traces, ContactState& state) {
  const Vector image = joined(state.lambda);
  Vector next = image;
  if (from_.size() == image.size() && !image.empty()) {
    const Vector rest = difference(image, from_);
    std::array<double, 1> size{product(traces, rest, rest)};
    traces.halo().sum_all(size);
    if (!last_rest_.empty()) {
      changes_.push_front({difference(rest, last_rest_), difference(image, last_image_)});
      if (size[0] > 4.0 * last_size_) changes_.clear();
      if (changes_.size() > static_cast<std::size_t>(tuning_.augmented_memory)) changes_.pop_back();
    }
    last_rest_ = rest;
    last_image_ = image;
    last_size_ = size[0];
    const std::size_t m = changes_.size();
    if (m > 0) {
      Vector sums;
      for (std::size_t a = 0; a < m; ++a) {
        for (std::size_t b = 0; b < m; ++b)
          sums.push_back(product(traces, changes_[a].rest, changes_[b].rest));
        sums.push_back(product(traces, changes_[a].rest, rest));
      }
      traces.halo().sum_all(sums);
      const auto n = static_cast<Eigen::Index>(m);
      Eigen::MatrixXd gram(n, n);
      Eigen::VectorXd right(n);
      for (std::size_t a = 0; a < m; ++a) {
        const auto row = static_cast<Eigen::Index>(a);
        for (std::size_t b = 0; b < m; ++b) gram(row, static_cast<Eigen::Index>(b)) = sums[a * (m + 1) + b];
        right(row) = sums[a * (m + 1) + m];
      }
      const Eigen::VectorXd scale = gram.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
      gram = scale.asDiagonal() * gram * scale.asDiagonal();
      gram.diagonal().array() += 1e-10;
      const Eigen::VectorXd share =
          scale.cwiseProduct(gram.ldlt().solve(Eigen::VectorXd(scale.cwiseProduct(right))));
      for (std::size_t a = 0; a < m; ++a)
        for (std::size_t i = 0; i < next.size(); ++i)
          next[i] -= share(static_cast<Eigen::Index>(a)) * changes_[a].image[i];
    } else {
      for (std::size_t i = 0; i < next.size(); ++i)
        next[i] = from_[i] + tuning_.augmented_following * rest[i];
    }
  }
  put(traces, next, state);
  from_ = joined(state.lambda);
}

void AugmentedControl::learn(int iterations) {
  if (iterations <= tuning_.augmented_few) penalty_ = std::min(most_, tuning_.augmented_change * penalty_);
  if (iterations >= tuning_.augmented_many) penalty_ /= tuning_.augmented_change;
}

}  // namespace kacanov
