// SPDX-License-Identifier: BSD-3-Clause
// Material laws of the dense reference solver, from the formulas in the documentation of case files.
#include "dense_laws.hpp"

#include <cmath>
#include <variant>

namespace kacanov::testing {
namespace {

/// Evaluates a table of stress at x: piecewise linear, the last piece extrapolated.
LawValues evaluate_table(const laws::Table& table, double x) {
  double energy = 0.0;
  for (std::size_t i = 1;; ++i) {
    const double from = table.x[i - 1], to = table.x[i], start = table.s[i - 1];
    const double rise = (table.s[i] - start) / (to - from);
    const bool here = x <= to || i + 1 == table.x.size();
    const double end = here ? x : to, stress = start + rise * (end - from);
    energy += 0.25 * (start + stress) * (end - from);
    if (here && i == 1) return {0.5 * rise, 0.0, energy};
    if (here) return {0.5 * stress / x, 0.5 * (rise - stress / x) / x, energy};
  }
}
/// Evaluates a table with the squared argument a = x²: g = s(a)/2a, so ∫ g x dx = ∫ s/4a da.
LawValues evaluate_squared_table(const laws::Table& table, double x) {
  const double a = x * x;
  double energy = 0.0;
  for (std::size_t i = 1;; ++i) {
    const double from = table.x[i - 1], to = table.x[i], start = table.s[i - 1];
    const double rise = (table.s[i] - start) / (to - from);
    const bool here = a <= to || i + 1 == table.x.size();
    const double end = here ? a : to, s = start + rise * (end - from);
    energy += 0.25 * rise * (end - from);
    if (i > 1) energy += 0.25 * (start - rise * from) * std::log(end / from);
    if (here && i == 1) return {0.5 * rise, 0.0, energy};
    if (here) return {0.5 * s / a, x * (rise - s / a) / a, energy};
  }
}
double yield(const Law& law) {
  return std::visit(
      [](const auto& form) {
        if constexpr (requires { form.x0; })
          return form.x0;
        else
          return 0.0;
      },
      law.form);
}
/// Evaluates a law with the squared argument.
LawValues evaluate_squared(const Law& law, double x) {
  if (const auto* table = std::get_if<laws::Table>(&law.form)) return evaluate_squared_table(*table, x);
  const double mu = law.shear, x0 = yield(law), a = x * x;
  if (law.linear() || a <= x0) return {mu, 0.0, 0.5 * mu * a};
  const double l = std::log(a / x0);
  if (std::holds_alternative<laws::Logarithmic>(law.form)) {
    return {mu * x0 / a * (l + 1.0), -2.0 * x * mu * x0 * l / (a * a),
            0.5 * mu * x0 * (1.0 + l + 0.5 * l * l)};
  }
  if (const auto* form = std::get_if<laws::LinearHardening>(&law.form)) {
    const double gamma = form->gamma;
    return {mu * (gamma + (1.0 - gamma) * x0 / a), -2.0 * x * mu * (1.0 - gamma) * x0 / (a * a),
            0.5 * mu * (x0 + gamma * (a - x0) + (1.0 - gamma) * x0 * l)};
  }
  if (const auto* form = std::get_if<laws::Power>(&law.form)) {
    const double n = form->n;
    const double g = mu * std::pow(a / x0, n - 1.0);
    return {g, 2.0 * x * (n - 1.0) * g / a, 0.5 * mu * x0 * (1.0 + (std::pow(a / x0, n) - 1.0) / n)};
  }
  if (const auto* form = std::get_if<laws::Saturating>(&law.form)) {
    const double q = form->q;
    // ∫ e^-b/qx₀ / b db from x₀ to a equals E₁(1/q) − E₁(a/qx₀), where E₁(z) = −Ei(−z).
    const double decay = std::exp(-(a - x0) / (q * x0)), g = mu * x0 / a * (1.0 + q * (1.0 - decay));
    const double faded = std::exp(1.0 / q) * (std::expint(-a / (q * x0)) - std::expint(-1.0 / q));
    return {g, 2.0 * x * (mu * decay - g) / a, 0.5 * mu * x0 * (1.0 + (1.0 + q) * l - q * faded)};
  }
  return {NAN, NAN, NAN};
}

}  // namespace

LawValues evaluate_law(const Law& law, double x) {
  if (law.argument == Law::Argument::squared) return evaluate_squared(law, x);
  if (const auto* table = std::get_if<laws::Table>(&law.form)) return evaluate_table(*table, x);
  const double mu = law.shear, x0 = yield(law);
  if (law.linear() || x <= x0) return {mu, 0.0, 0.5 * mu * x * x};
  const double below = 0.5 * mu * x0 * x0;
  if (std::holds_alternative<laws::Logarithmic>(law.form)) {
    const double l = std::log(x / x0);
    return {mu * x0 / x * (l + 1.0), -mu * x0 * l / (x * x), below + mu * x0 * x * l};
  }
  if (const auto* form = std::get_if<laws::LinearHardening>(&law.form)) {
    const double gamma = form->gamma;
    return {mu * (gamma + (1.0 - gamma) * x0 / x), -mu * (1.0 - gamma) * x0 / (x * x),
            below + mu * (0.5 * gamma * (x * x - x0 * x0) + (1.0 - gamma) * x0 * (x - x0))};
  }
  if (const auto* form = std::get_if<laws::Power>(&law.form)) {
    const double n = form->n;
    return {mu * std::pow(x / x0, n - 1.0), mu * (n - 1.0) / x * std::pow(x / x0, n - 1.0),
            below + mu * x0 * x0 * (std::pow(x / x0, n + 1.0) - 1.0) / (n + 1.0)};
  }
  if (const auto* form = std::get_if<laws::Saturating>(&law.form)) {
    const double q = form->q;
    const double decay = std::exp(-(x - x0) / (q * x0)), stress = mu * x0 * (1.0 + q * (1.0 - decay));
    return {stress / x, (mu * decay - stress / x) / x,
            below + mu * x0 * ((1.0 + q) * (x - x0) - q * q * x0 * (1.0 - decay))};
  }
  return {NAN, NAN, NAN};
}

}  // namespace kacanov::testing
