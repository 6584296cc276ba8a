// SPDX-License-Identifier: BSD-3-Clause
// Closed forms of the Hencky laws: g, dg/dx and G(x) = ∫₀ˣ g(s) s ds, for both arguments.
#include <kacanov/law.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kacanov {
namespace {

/// e^z E₁(z) for z > 0, E₁(z) = ∫_z^∞ e^-t/t dt: never over- or underflows where e^z and E₁ would.
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

/// A straight piece of the table: s = start_s + slope (a − start_a).
struct Piece {
  double start_a, start_s, slope;
};

/// Index of the table's first point that is not the origin.
std::size_t first_point(const Law& law) {
  std::size_t i = 0;
  while (i + 1 < law.table_x.size() && law.table_x[i] <= 0.0) ++i;
  return i;
}

/// The piece that ends at point i.
Piece piece_to(const Law& law, std::size_t i, std::size_t first) {
  const double a0 = i == first ? 0.0 : law.table_x[i - 1];
  const double s0 = i == first ? 0.0 : law.table_s[i - 1];
  return {a0, s0, (law.table_s[i] - s0) / (law.table_x[i] - a0)};
}

Piece piece_at(const Law& law, double a) {
  const std::size_t first = first_point(law);
  const auto begin = law.table_x.begin() + static_cast<std::ptrdiff_t>(first);
  const auto above = std::upper_bound(begin, law.table_x.end(), a) - law.table_x.begin();
  const std::size_t last = law.table_x.size() - 1;
  return piece_to(law, std::min(static_cast<std::size_t>(above), last), first);
}

/// The end of the proportional range.
double yield_argument(const Law& law) {
  if (law.kind == Law::Kind::linear) return std::numeric_limits<double>::infinity();
  if (law.kind == Law::Kind::table) return law.table_x[first_point(law)];
  return law.x0;
}

Law::Moduli table_moduli(const Law& law, double a) {
  const Piece piece = piece_at(law, a);
  if (piece.start_a == 0.0) return {0.5 * piece.slope, 0.0};
  const double s = piece.start_s + piece.slope * (a - piece.start_a);
  return {0.5 * s / a, 0.5 * (piece.slope - s / a) / a};
}

/// g and dg/da at the argument a.
Law::Moduli moduli_of_argument(const Law& law, double a) {
  if (law.kind == Law::Kind::table) return table_moduli(law, a);
  if (a <= yield_argument(law)) return {law.shear, 0.0};
  const double mu = law.shear;
  const double ratio = law.x0 / a;
  switch (law.kind) {
    case Law::Kind::logarithmic: {
      const double l = -std::log(ratio);
      return {mu * ratio * (l + 1.0), -mu * ratio * l / a};
    }
    case Law::Kind::linear_hardening: {
      const double drop = mu * (1.0 - law.gamma) * ratio;
      return {mu * law.gamma + drop, -drop / a};
    }
    case Law::Kind::power: {
      const double g = mu * std::pow(ratio, 1.0 - law.n);
      return {g, (law.n - 1.0) * g / a};
    }
    case Law::Kind::saturating: {
      const double decay = std::exp(-(a - law.x0) / (law.q * law.x0));
      const double g = mu * ratio * (1.0 + law.q * (1.0 - decay));
      return {g, (mu * decay - g) / a};
    }
    case Law::Kind::linear:
    case Law::Kind::table: break;
  }
  return {mu, 0.0};
}

/// ∫ g(a) a da from x0 to a > x0.
double energy_beyond_yield(const Law& law, double a) {
  const double mu = law.shear, x0 = law.x0;
  switch (law.kind) {
    case Law::Kind::logarithmic: return mu * x0 * a * std::log(a / x0);
    case Law::Kind::linear_hardening:
      return mu * (a - x0) * (0.5 * law.gamma * (a + x0) + (1.0 - law.gamma) * x0);
    case Law::Kind::power: return mu * x0 * x0 * (std::pow(a / x0, law.n + 1.0) - 1.0) / (law.n + 1.0);
    case Law::Kind::saturating: {
      const double z = (a - x0) / (law.q * x0);
      return mu * x0 * ((1.0 + law.q) * (a - x0) + law.q * law.q * x0 * std::expm1(-z));
    }
    case Law::Kind::linear:
    case Law::Kind::table: break;
  }
  return 0.0;
}

/// ∫ g(a) da from x0 to a > x0.
double plain_integral_beyond_yield(const Law& law, double a) {
  const double mu = law.shear, x0 = law.x0;
  const double l = std::log(a / x0);
  switch (law.kind) {
    case Law::Kind::logarithmic: return mu * x0 * l * (1.0 + 0.5 * l);
    case Law::Kind::linear_hardening: return mu * (law.gamma * (a - x0) + (1.0 - law.gamma) * x0 * l);
    case Law::Kind::power: return mu * x0 * (std::pow(a / x0, law.n) - 1.0) / law.n;
    case Law::Kind::saturating: {
      const double u = 1.0 / law.q, v = a / (law.q * x0);
      const double part = scaled_exponential_integral(u) - std::exp(u - v) * scaled_exponential_integral(v);
      return mu * x0 * ((1.0 + law.q) * l - law.q * part);
    }
    case Law::Kind::linear:
    case Law::Kind::table: break;
  }
  return 0.0;
}

/// G for a table: sums of ½∫ s da (norm) or ¼∫ s/a da (squared) over the pieces up to a.
double table_energy(const Law& law, double a) {
  const bool squared = law.argument == Law::Argument::squared;
  const std::size_t first = first_point(law), last = law.table_x.size() - 1;
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const Piece piece = piece_to(law, i, first);
    const double end = i == last ? a : std::min(a, law.table_x[i]);
    const double length = end - piece.start_a;
    if (length <= 0.0) break;
    if (squared) {
      sum += 0.25 * piece.slope * length;
      if (piece.start_a > 0.0)
        sum += 0.25 * (piece.start_s - piece.slope * piece.start_a) * std::log(end / piece.start_a);
    } else {
      sum += 0.5 * length * (piece.start_s + 0.5 * piece.slope * length);
    }
  }
  return sum;
}

double argument_of(const Law& law, double x) { return law.argument == Law::Argument::squared ? x * x : x; }

}  // namespace

Law::Moduli Law::moduli(double x) const {
  Moduli m = moduli_of_argument(*this, argument_of(*this, x));
  if (argument == Argument::squared) m.derivative *= 2.0 * x;
  return m;
}

double Law::secant(double x) const { return moduli(x).secant; }

double Law::secant_derivative(double x) const { return moduli(x).derivative; }

double Law::energy(double x) const {
  const double a = argument_of(*this, x);
  if (kind == Kind::table) return table_energy(*this, a);
  const bool beyond = a > yield_argument(*this);
  const double below = beyond ? x0 : a;
  if (argument == Argument::squared)
    return 0.5 * (shear * below + (beyond ? plain_integral_beyond_yield(*this, a) : 0.0));
  return 0.5 * shear * below * below + (beyond ? energy_beyond_yield(*this, a) : 0.0);
}

bool Law::softens(double x) const {
  const auto [g, derivative] = moduli(x);
  return g + x * derivative < -1e-12 * g;  // a saturated law must not soften by rounding
}

bool Law::plastic(double x) const { return argument_of(*this, x) > yield_argument(*this); }

Law elastic_law(double young, double poisson) {
  Law law;
  law.bulk = young / (3.0 * (1.0 - 2.0 * poisson));
  law.shear = young / (2.0 * (1.0 + poisson));
  return law;
}

}  // namespace kacanov
