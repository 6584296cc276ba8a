// SPDX-License-Identifier: BSD-3-Clause
// Reference solution for thick cylinders and spheres under inner pressure: the radial equation by shooting,
// for any law and Poisson's ratio.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <kacanov/law.hpp>

namespace kacanov::testing {

/// Solves τ_r' + m (τ_r − τ_θ)/r = 0 on [a, b] with ε_r = u', ε_θ = u/r, τ_r(a) = −p, τ_r(b) = 0; m = 1 for
/// the cylinder in plane strain, 2 for the sphere. The state is (u, τ_r); u' follows from τ_r, which is
/// monotone in u'.
class RadialSolution {
 public:
  RadialSolution(const Law& law, int m, double a, double b, double pressure, int steps = 2000)
      : law_(law), m_(m), a_(a), step_((b - a) / steps), u_(static_cast<std::size_t>(steps) + 1) {
    // τ_r(b) is monotone in u(a): bisection.
    double low = 0.0, high = 1e-6 * a;
    while (shoot(high, pressure) < 0.0) high *= 2.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (shoot(middle, pressure) < 0.0 ? low : high) = middle;
    }
    shoot(high, pressure);
  }

  /// Returns the radial displacement at r.
  double operator()(double r) const {
    const double at = std::clamp((r - a_) / step_, 0.0, static_cast<double>(u_.size()) - 1.000001);
    const auto i = static_cast<std::size_t>(at);
    const double t = at - static_cast<double>(i);
    return (1 - t) * u_[i] + t * u_[i + 1];
  }
  double largest_dev_strain() const { return largest_; }

 private:
  struct Strain {
    double radial, hoop;
  };
  struct Stress {
    double radial, hoop, dev_strain;
  };
  Stress stress(const Strain& e) const {
    const double third = (e.radial + m_ * e.hoop) / 3.0;
    const double dr = e.radial - third, dt = e.hoop - third, dz = -third;
    // The third strain is 0 in plane strain, and a second hoop strain on the sphere.
    const double x = std::sqrt(dr * dr + dt * dt + (m_ == 1 ? dz * dz : dt * dt));
    const double g = law_.secant(x), mean = 3.0 * law_.bulk * third;
    return {mean + 2 * g * dr, mean + 2 * g * dt, x};
  }
  double radial_strain(double hoop, double tau) const {
    double high = 1.0 + 3.0 * std::abs(hoop), low = -high;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (stress({middle, hoop}).radial < tau ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  struct State {
    double u, tau;
  };
  State slope(double r, const State& s) const {
    const double du = radial_strain(s.u / r, s.tau);
    return {du, -m_ * (s.tau - stress({du, s.u / r}).hoop) / r};
  }
  /// Returns τ_r(b) for a given u(a), by Runge's midpoint rule; fills u_.
  double shoot(double u_inner, double pressure) {
    State s{u_inner, -pressure};
    u_[0] = u_inner;
    largest_ = stress({radial_strain(u_inner / a_, -pressure), u_inner / a_}).dev_strain;
    for (std::size_t i = 1; i < u_.size(); ++i) {
      const double r = a_ + step_ * static_cast<double>(i - 1);
      const State first = slope(r, s);
      const State middle =
          slope(r + 0.5 * step_, {s.u + 0.5 * step_ * first.u, s.tau + 0.5 * step_ * first.tau});
      s = {s.u + step_ * middle.u, s.tau + step_ * middle.tau};
      u_[i] = s.u;
    }
    return s.tau;
  }

  Law law_;
  int m_;
  double a_, step_, largest_ = 0.0;
  std::vector<double> u_;
};

}  // namespace kacanov::testing
