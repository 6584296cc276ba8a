// SPDX-License-Identifier: BSD-3-Clause
// The augmented Lagrangian of contact and friction as a function of the traces.
#include "contact/augmented.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/projections.hpp"

namespace kacanov {

AugmentedContact::AugmentedContact(const Traces& traces, const ContactState& state, double r)
    : traces_(&traces), state_(&state), r_(r) {}

std::array<double, 2> AugmentedContact::pull(const ContactValues& trace, std::size_t i) const {
  return {state_->lambda.tangential[2 * i] + r_ * trace.tangential[2 * i],
          state_->lambda.tangential[2 * i + 1] + r_ * trace.tangential[2 * i + 1]};
}

double AugmentedContact::value(const ContactValues& trace) const {
  const auto points = traces_->points().first(traces_->owned());
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double lambda = state_->lambda.normal[i];
    const double pushed = std::max(lambda + r_ * (trace.normal[i] - state_->gap[i]), 0.0);
    double here = pushed * pushed - lambda * lambda;
    if (points[i].tangents > 0) {
      const auto s = pull(trace, i);
      const double length = std::hypot(s[0], s[1]), bound = state_->bound[i];
      const double* held = &state_->lambda.tangential[2 * i];
      here += (length <= bound ? length * length : bound * (2.0 * length - bound)) - held[0] * held[0] -
              held[1] * held[1];
    }
    sum += points[i].mass * here;
  }
  return traces_->ranks().sum_all(0.5 / r_ * sum);
}

ContactValues AugmentedContact::multipliers(const ContactValues& trace) const {
  ContactValues next(traces_->size());
  for (std::size_t i = 0; i < traces_->size(); ++i) {
    next.normal[i] = normal_step(trace.normal[i], state_->lambda.normal[i], state_->gap[i], r_).lambda;
    if (traces_->points()[i].tangents == 0) continue;
    const TangentialStep step =
        tangential_step(&trace.tangential[2 * i], &state_->lambda.tangential[2 * i], state_->bound[i], r_);
    for (std::size_t k = 0; k < static_cast<std::size_t>(traces_->points()[i].tangents); ++k)
      next.tangential[2 * i + k] = step.lambda[k];
  }
  return next;
}

ActiveSet AugmentedContact::derivative(const ContactValues& trace) const {
  const auto points = traces_->points();
  ActiveSet set(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    set.held[i].normal = state_->lambda.normal[i] + r_ * (trace.normal[i] - state_->gap[i]) > 0.0;
    if (points[i].tangents == 0) continue;
    const auto s = pull(trace, i);
    const double length = std::hypot(s[0], s[1]), bound = state_->bound[i];
    set.held[i].tangential = bound > 0.0 && length <= bound;
    if (set.held[i].tangential || length == 0.0) continue;
    for (std::size_t k = 0; k < 2; ++k) {
      set.slip_direction[2 * i + k] = s[k] / length;
      set.slip_force[2 * i + k] = bound * s[k] / length;
    }
    if (points[i].tangents == 2) set.slip_stiffness[i] = r_ * bound / length;
  }
  return set;
}

double AugmentedContact::add_stiffness(const ActiveSet& set, std::span<const double> x,
                                       std::span<double> y) const {
  const auto points = traces_->points();
  ContactValues trace(points.size());
  traces_->evaluate(x, trace);
  double share = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double normal = trace.normal[i];
    double* w = &trace.tangential[2 * i];
    const std::array<double, 2> before{w[0], w[1]};
    trace.normal[i] = set.held[i].normal ? r_ * normal : 0.0;
    if (set.held[i].tangential) {
      for (std::size_t k = 0; k < 2; ++k) w[k] *= r_;
    } else {
      const double* s = &set.slip_direction[2 * i];
      const double along = w[0] * s[0] + w[1] * s[1];
      for (std::size_t k = 0; k < 2; ++k) w[k] = set.slip_stiffness[i] * (w[k] - along * s[k]);
    }
    if (i < traces_->owned())
      share += points[i].mass * (trace.normal[i] * normal + w[0] * before[0] + w[1] * before[1]);
  }
  traces_->add_force(trace, 1.0, y);
  return share;
}

}  // namespace kacanov
