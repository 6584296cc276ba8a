// SPDX-License-Identifier: BSD-3-Clause
// Closed forms of g, dg/da and the integrals of g, and the ranges of their parameters (theory: laws).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

#include <kacanov/law.hpp>
#include "law/parameter.hpp"

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
