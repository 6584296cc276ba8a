// SPDX-License-Identifier: BSD-3-Clause
// The Ramberg–Osgood law gives strain as a function of stress; Newton's method finds g (theory:
// law-ramberg-osgood).
#include <algorithm>
#include <cmath>

#include <kacanov/law.hpp>
#include "law/parameter.hpp"

namespace kacanov::laws {
namespace {

/// Solves t + a tⁿ = strain. The function is convex and increasing: from above, Newton's method is monotone.
double stress(double a, double n, double strain) {
  double t = std::min(strain, std::pow(strain / a, 1.0 / n));
  for (int i = 0; i < 60; ++i) {
    const double power = a * std::pow(t, n - 1.0);
    const double step = (t + power * t - strain) / (1.0 + n * power);
    t -= step;
    if (!(step > 1e-16 * t)) break;
  }
  return t;
}

/// ∫ t dx / x0 from 0.
double energy_to(double a, double n, double t) {
  return 0.5 * t * t + a * n * std::pow(t, n + 1.0) / (n + 1.0);
}

}  // namespace

std::string RambergOsgood::fault() const {
  if (std::string fault = positive("x0", x0); !fault.empty()) return fault;
  if (std::string fault = positive("a", a); !fault.empty()) return fault;
  return n > 1.0 && std::isfinite(n) ? std::string() : refusal("n", "a number > 1", n);
}

double RambergOsgood::yield() const {
  // Up to this strain g differs from μ by less than rounding.
  constexpr double nothing = 1e-17;
  return x0 * std::pow(nothing / a, 1.0 / (n - 1.0));
}

Moduli RambergOsgood::moduli(double mu, double x) const {
  const double strain = x / x0, t = stress(a, n, strain);
  const double slope = 1.0 / (1.0 + a * n * std::pow(t, n - 1.0));
  return {mu * t / strain, mu * (slope - t / strain) / x};
}

double RambergOsgood::energy(double mu, double x) const {
  const double first = yield() / x0;
  return mu * x0 * x0 * (energy_to(a, n, stress(a, n, x / x0)) - 0.5 * first * first);
}

}  // namespace kacanov::laws
