// SPDX-License-Identifier: BSD-3-Clause
// A law of any form, for both arguments, and what makes one valid.
#include <kacanov/law.hpp>

#include <algorithm>
#include <cmath>

#include "law/parameter.hpp"

namespace kacanov {
namespace {

double argument_of(const Law& law, double x) { return law.argument == Law::Argument::squared ? x * x : x; }

}  // namespace

Moduli Law::moduli(double x) const {
  const double a = argument_of(*this, x);
  return std::visit(
      [&](const auto& f) -> Moduli {
        if (a <= f.yield()) return {f.initial(shear), 0.0};
        const Moduli m = f.moduli(shear, a);
        return {m.secant, argument == Argument::squared ? 2.0 * x * m.derivative : m.derivative};
      },
      form);
}

double Law::secant(double x) const { return moduli(x).secant; }

double Law::secant_derivative(double x) const { return moduli(x).derivative; }

double Law::energy(double x) const {
  const double a = argument_of(*this, x);
  return std::visit(
      [&](const auto& f) {
        const bool beyond = a > f.yield();
        const double below = beyond ? f.yield() : a, g = f.initial(shear);
        if (argument == Argument::squared)
          return 0.5 * (g * below + (beyond ? f.plain_energy(shear, a) : 0.0));
        return 0.5 * g * below * below + (beyond ? f.energy(shear, a) : 0.0);
      },
      form);
}

double Law::yield_strain() const {
  const double a = std::visit([](const auto& f) { return f.yield(); }, form);
  return argument == Argument::squared ? std::sqrt(a) : a;
}

bool Law::softens(double x) const {
  const auto [g, derivative] = moduli(x);
  return g + x * derivative < -1e-12 * g;  // a saturated law must not soften by rounding
}

bool Law::plastic(double x) const {
  return argument_of(*this, x) > std::visit([](const auto& f) { return f.yield(); }, form);
}

std::string validate(const Law& law) {
  if (std::string fault = laws::positive("bulk", law.bulk); !fault.empty()) return fault;
  if (std::string fault = laws::positive("shear", law.shear); !fault.empty()) return fault;
  return std::visit([](const auto& f) { return f.fault(); }, law.form);
}

Law elastic_law(double young, double poisson) {
  Law law;
  law.bulk = young / (3.0 * (1.0 - 2.0 * poisson));
  law.shear = young / (2.0 * (1.0 + poisson));
  return law;
}

}  // namespace kacanov
