// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws: validation, the forms of g with derivative and energy, and conversion from uniaxial curves.
#include <kacanov/law.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace kacanov::laws {

/// Returns "name: expected ..., got value".
std::string refusal(const std::string& name, const std::string& expected, double value);
/// Returns an error message unless the value is finite and > 0; otherwise empty.
std::string positive(const std::string& name, double value);
/// Returns an error message unless 0 < value ≤ 1; otherwise empty.
std::string fraction(const std::string& name, double value);

}  // namespace kacanov::laws

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

namespace kacanov::laws {
namespace {

/// e^z E₁(z) for z > 0, E₁(z) = ∫_z^∞ e^-t/t dt, without overflow or underflow of its factors.
double scaled_exponential_integral(double z) {
  if (z < 1.0) return -std::exp(z) * std::expint(-z);
  // Continued fraction 1/(z+1-1/(z+3-4/(z+5-...))), Lentz's algorithm.
  double b = z + 1.0;
  double c = 1.0 / std::numeric_limits<double>::min();
  double d = 1.0 / b;
  double value = d;
  for (int i = 1; i < 200; ++i) {
    const double a = -static_cast<double>(i) * i;
    b += 2.0;
    d = 1.0 / (a * d + b);
    c = b + a / c;
    value *= c * d;
    if (std::abs(c * d - 1.0) < 1e-16) break;
  }
  return value;
}

/// A linear segment of a table: s = start_s + slope (a − start_a).
struct Piece {
  double start_a, start_s, slope;
};

/// The segment that ends at point i ≥ 1.
Piece piece_to(const Table& table, std::size_t i) {
  const double a = table.x[i - 1], s = table.s[i - 1];
  return {a, s, (table.s[i] - s) / (table.x[i] - a)};
}

/// Calls visit(segment, its length up to a) for all segments beyond the first.
template <class Visit>
void for_pieces_beyond_first(const Table& table, double a, Visit&& visit) {
  const std::size_t last = table.x.size() - 1;
  for (std::size_t i = std::min<std::size_t>(2, last); i <= last; ++i) {
    Piece piece = piece_to(table, i);
    if (i == 1)  // a table with one segment, extrapolated
      piece = {table.x[1], table.s[1], piece.slope};
    const double length = (i == last ? a : std::min(a, table.x[i])) - piece.start_a;
    if (length <= 0.0) break;
    visit(piece, length);
  }
}

}  // namespace

std::string refusal(const std::string& name, const std::string& expected, double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return name + ": expected " + expected + ", got " + std::string(text, end);
}

std::string positive(const std::string& name, double value) {
  return value > 0.0 && std::isfinite(value) ? std::string() : refusal(name, "a number > 0", value);
}

std::string fraction(const std::string& name, double value) {
  return value > 0.0 && value <= 1.0 ? std::string() : refusal(name, "a number > 0 and ≤ 1", value);
}

std::string Logarithmic::fault() const { return positive("x0", x0); }

Moduli Logarithmic::moduli(double mu, double a) const {
  const double ratio = x0 / a, l = -std::log(ratio);
  return {mu * ratio * (l + 1.0), -mu * ratio * l / a};
}

double Logarithmic::energy(double mu, double a) const { return mu * x0 * a * std::log(a / x0); }

double Logarithmic::plain_energy(double mu, double a) const {
  const double l = std::log(a / x0);
  return mu * x0 * l * (1.0 + 0.5 * l);
}

std::string LinearHardening::fault() const {
  const std::string fault = positive("x0", x0);
  // With gamma = 0 the displacement would not be unique.
  return fault.empty() ? fraction("gamma", gamma) : fault;
}

Moduli LinearHardening::moduli(double mu, double a) const {
  const double drop = mu * (1.0 - gamma) * (x0 / a);
  return {mu * gamma + drop, -drop / a};
}

double LinearHardening::energy(double mu, double a) const {
  return mu * (a - x0) * (0.5 * gamma * (a + x0) + (1.0 - gamma) * x0);
}

double LinearHardening::plain_energy(double mu, double a) const {
  return mu * (gamma * (a - x0) + (1.0 - gamma) * x0 * std::log(a / x0));
}

std::string Power::fault() const {
  const std::string fault = positive("x0", x0);
  return fault.empty() ? fraction("n", n) : fault;
}

Moduli Power::moduli(double mu, double a) const {
  const double g = mu * std::pow(x0 / a, 1.0 - n);
  return {g, (n - 1.0) * g / a};
}

double Power::energy(double mu, double a) const {
  return mu * x0 * x0 * (std::pow(a / x0, n + 1.0) - 1.0) / (n + 1.0);
}

double Power::plain_energy(double mu, double a) const { return mu * x0 * (std::pow(a / x0, n) - 1.0) / n; }

std::string Saturating::fault() const {
  const std::string fault = positive("x0", x0);
  return fault.empty() ? positive("q", q) : fault;
}

Moduli Saturating::moduli(double mu, double a) const {
  const double decay = std::exp(-(a - x0) / (q * x0));
  const double g = mu * (x0 / a) * (1.0 + q * (1.0 - decay));
  return {g, (mu * decay - g) / a};
}

double Saturating::energy(double mu, double a) const {
  const double z = (a - x0) / (q * x0);
  return mu * x0 * ((1.0 + q) * (a - x0) + q * q * x0 * std::expm1(-z));
}

double Saturating::plain_energy(double mu, double a) const {
  const double u = 1.0 / q, v = a / (q * x0);
  const double part = scaled_exponential_integral(u) - std::exp(u - v) * scaled_exponential_integral(v);
  return mu * x0 * ((1.0 + q) * std::log(a / x0) - q * part);
}

std::string Table::fault() const {
  const auto at = [](std::size_t i, int k) {
    return "points[" + std::to_string(i) + "]" + (k < 0 ? "" : "[" + std::to_string(k) + "]");
  };
  if (x.size() < 2 || s.size() != x.size()) return "points: expected a list of pairs [x, s] from [0, 0] on";
  if (x[0] != 0.0 || s[0] != 0.0) return at(0, -1) + ": expected [0, 0] as the first point";
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] > x[i - 1]) || !std::isfinite(x[i]))
      return refusal(at(i, 0), "a strain above that of the point before", x[i]);
    if (!(s[i] > s[i - 1]) || !std::isfinite(s[i]))
      return refusal(at(i, 1), "a stress above that of the point before", s[i]);
    // Collinear points with rounded numbers do not count as an increase.
    if (i > 1 && s[i] / x[i] > s[i - 1] / x[i - 1] * (1.0 + 1e-9))
      return refusal(at(i, -1), "a secant s/x not above that of the point before", s[i] / x[i]);
  }
  return {};
}

Moduli Table::moduli(double, double a) const {
  const std::size_t above = std::upper_bound(x.begin() + 1, x.end(), a) - x.begin();
  const Piece piece = piece_to(*this, std::min(above, x.size() - 1));
  if (piece.start_a == 0.0) return {0.5 * piece.slope, 0.0};
  const double stress = piece.start_s + piece.slope * (a - piece.start_a);
  return {0.5 * stress / a, 0.5 * (piece.slope - stress / a) / a};
}

double Table::energy(double, double a) const {
  double sum = 0.0;
  for_pieces_beyond_first(*this, a, [&](const Piece& piece, double length) {
    sum += 0.5 * length * (piece.start_s + 0.5 * piece.slope * length);
  });
  return sum;
}

double Table::plain_energy(double, double a) const {
  double sum = 0.0;
  for_pieces_beyond_first(*this, a, [&](const Piece& piece, double length) {
    sum += 0.5 * piece.slope * length + 0.5 * (piece.start_s - piece.slope * piece.start_a) *
                                            std::log((piece.start_a + length) / piece.start_a);
  });
  return sum;
}

}  // namespace kacanov::laws

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

namespace kacanov {
namespace {

/// ‖dev τ‖ of a uniaxial stress.
double deviator(double stress) { return std::sqrt(2.0 / 3.0) * stress; }

}  // namespace

Law elastic_law(double young, double poisson) {
  Law law;
  law.bulk = young / (3.0 * (1.0 - 2.0 * poisson));
  law.shear = young / (2.0 * (1.0 + poisson));
  return law;
}

double young_modulus(const Law& law) { return 9.0 * law.bulk * law.shear / (3.0 * law.bulk + law.shear); }

laws::Table plastic_table(const Law& elastic, std::span<const std::array<double, 2>> rows) {
  const double slope = 2.0 * elastic.shear;
  laws::Table table{{0.0}, {0.0}};
  for (const auto& [stress, plastic_strain] : rows) {
    const double s = deviator(stress), x = s / slope + std::sqrt(1.5) * plastic_strain;
    // Lower bound of the stress: a plateau with a small slope.
    const double least =
        table.x.size() > 1 ? table.s.back() + plateau_slope * slope * (x - table.x.back()) : 0.0;
    table.x.push_back(x);
    table.s.push_back(std::max(s, least));
  }
  const double beyond = table.x[1];
  table.x.push_back(table.x.back() + beyond);
  table.s.push_back(table.s.back() + plateau_slope * slope * beyond);
  return table;
}

laws::LinearHardening bilinear(const Law& elastic, double yield_stress, double tangent) {
  const double young = young_modulus(elastic), plastic = young * tangent / (young - tangent);
  return {deviator(yield_stress) / (2.0 * elastic.shear), plastic / (plastic + 3.0 * elastic.shear)};
}

laws::RambergOsgood ramberg_osgood(const Law& elastic, double sigma0, double alpha, double n) {
  return {deviator(sigma0) / (2.0 * elastic.shear), 3.0 * elastic.shear * alpha / young_modulus(elastic), n};
}

}  // namespace kacanov
