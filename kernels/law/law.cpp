// SPDX-License-Identifier: BSD-3-Clause
// Evaluation and validation of a law of any form, for both arguments.
#include <kacanov/law.hpp>

#include <algorithm>
#include <cmath>

#include "law/parameter.hpp"

namespace kacanov {
namespace {

template <class Form>
concept takes_squares = requires(const Form& f) {
  f.plain_energy(1.0, 1.0);
};

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
        if constexpr (takes_squares<decltype(f)>)
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

double Law::proof_strain() const {
  const double a = std::visit(
      [](const auto& f) {
        if constexpr (requires { f.proof(); })
          return f.proof();
        else
          return f.yield();
      },
      form);
  return argument == Argument::squared ? std::sqrt(a) : a;
}

bool Law::softens(double x) const {
  const auto [g, derivative] = moduli(x);
  return g + x * derivative < -1e-12 * g;  // a saturated law must not soften by rounding
}

bool Law::plastic(double x) const {
  return std::visit(
      [&](const auto& f) {
        if constexpr (requires { f.proof(); })
          return argument_of(*this, x) > f.proof();
        else
          return argument_of(*this, x) > f.yield();
      },
      form);
}

std::string validate(const Law& law) {
  if (std::string fault = laws::positive("bulk", law.bulk); !fault.empty()) return fault;
  if (std::string fault = laws::positive("shear", law.shear); !fault.empty()) return fault;
  return std::visit(
      [&](const auto& f) -> std::string {
        if (law.argument == Law::Argument::squared && !takes_squares<decltype(f)>)
          return "argument: expected \"norm\" for this form, got \"squared\"";
        return f.fault();
      },
      law.form);
}

}  // namespace kacanov
