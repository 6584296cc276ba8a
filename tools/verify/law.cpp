// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws by formula, and their energy by quadrature (theory: laws, energy).
#include "verify/law.hpp"

#include <algorithm>

namespace kacanov::verify {
namespace {

Real table_stress(const Law& law, Real a) {
  std::size_t end = 1;
  while (end + 1 < law.x.size() && a > law.x[end]) ++end;
  const Real slope = (law.s[end] - law.s[end - 1]) / (law.x[end] - law.x[end - 1]);
  return law.s[end - 1] + slope * (a - law.x[end - 1]);
}

/// Returns the elastic share y of the strain x, the root of y (1 + share (y x / x0)^(n − 1)) = 1, by Newton's
/// method from above, which decreases monotonically for an increasing convex function.
Real elastic_share(const Law& law, Real x) {
  Real y = 1;
  for (int step = 0; step < 1000; ++step) {
    const Real over = law.share * std::pow(y * x / law.x0, law.parameter - 1);
    const Real next = y - (y * (1 + over) - 1) / (1 + law.parameter * over);
    if (!(next < y)) break;
    y = next;
  }
  return y;
}

Real deviator(Real stress) { return std::sqrt(Real(2) / 3) * stress; }

/// Reads rows of uniaxial stress and plastic strain (theory: uniaxial). Each stress rises with at least 1e-4
/// of the elastic slope.
void read_plastic(const nlohmann::json& rows, Law& law) {
  law.form = Law::Form::table;
  law.x = law.s = {0};
  const Real slope = 1e-4L * 2 * law.shear;
  for (const auto& row : rows) {
    const Real s = deviator(row.at(0).get<double>());
    const Real x = s / (2 * law.shear) + std::sqrt(Real(3) / 2) * Real(row.at(1).get<double>());
    const Real least = law.x.size() > 1 ? law.s.back() + slope * (x - law.x.back()) : 0;
    law.x.push_back(x);
    law.s.push_back(std::max(s, least));
  }
  law.x.push_back(law.x.back() + law.x[1]);
  law.s.push_back(law.s.back() + slope * law.x[1]);
}

/// Returns ∫ g(s) s ds from a to b with five Gauss points; the law is smooth between a and b.
Real piece(const Law& law, Real a, Real b) {
  static const Real inner = std::sqrt(5 - 2 * std::sqrt(Real(10) / 7)) / 3,
                    outer = std::sqrt(5 + 2 * std::sqrt(Real(10) / 7)) / 3, root = 13 * std::sqrt(Real(70));
  static const std::array<std::pair<Real, Real>, 5> rule{{{0, Real(128) / 225},
                                                          {inner, (322 + root) / 900},
                                                          {-inner, (322 + root) / 900},
                                                          {outer, (322 - root) / 900},
                                                          {-outer, (322 - root) / 900}}};
  Real sum = 0;
  for (const auto& [at, weight] : rule) {
    const Real x = (a + b) / 2 + at * (b - a) / 2;
    sum += weight * law.secant(x) * x;
  }
  return sum * (b - a) / 2;
}

Real halved_until_it_settles(const Law& law, Real a, Real b, Real whole, int depth) {
  const Real middle = (a + b) / 2, left = piece(law, a, middle), right = piece(law, middle, b);
  if (depth == 0 || std::abs(left + right - whole) <= 1e-14L * std::abs(whole)) return left + right;
  return halved_until_it_settles(law, a, middle, left, depth - 1) +
         halved_until_it_settles(law, middle, b, right, depth - 1);
}

}  // namespace

Real Law::secant(Real strain) const {
  const Real a = squared ? strain * strain : strain;
  if (form == Form::ramberg_osgood) return a > 0 ? shear * elastic_share(*this, a) : shear;
  if (form == Form::table) return a > x[1] ? table_stress(*this, a) / (2 * a) : s[1] / (2 * x[1]);
  if (form == Form::linear || a <= x0) return shear;
  switch (form) {
    case Form::logarithmic: return shear * x0 / a * (std::log(a / x0) + 1);
    case Form::linear_hardening: return shear * (parameter + (1 - parameter) * x0 / a);
    case Form::power: return shear * std::pow(a / x0, parameter - 1);
    default: return shear * x0 / a * (1 + parameter * (1 - std::exp(-(a - x0) / (parameter * x0))));
  }
}

Real Law::energy(Real strain) const {
  std::vector<Real> kinks = form == Form::table ? x : std::vector<Real>{0, x0};
  if (squared)
    for (Real& kink : kinks) kink = std::sqrt(kink);
  Real sum = 0, from = 0;
  if (form != Form::linear)
    for (const Real kink : kinks) {
      if (!(kink > from) || !(kink < strain)) continue;
      sum += halved_until_it_settles(*this, from, kink, piece(*this, from, kink), 40);
      from = kink;
    }
  return sum + halved_until_it_settles(*this, from, strain, piece(*this, from, strain), 40);
}

namespace {

/// Reads a law without its B-bar setting.
Law read_form(const nlohmann::json& entry) {
  Law law;
  const Real young = entry.at("young").get<double>(), poisson = entry.at("poisson").get<double>();
  law.bulk = young / (3 * (1 - 2 * poisson));
  law.shear = young / (2 * (1 + poisson));
  if (entry.contains("plastic")) read_plastic(entry.at("plastic"), law);
  if (entry.contains("tangent_modulus")) {
    const Real tangent = entry.at("tangent_modulus").get<double>();
    const Real plastic = young * tangent / (young - tangent);
    law.form = Law::Form::linear_hardening;
    law.x0 = deviator(entry.at("yield_stress").get<double>()) / (2 * law.shear);
    law.parameter = plastic / (plastic + 3 * law.shear);
  }
  if (!entry.contains("law")) return law;
  const nlohmann::json& text = entry.at("law");
  static const char* names[] = {"linear",     "logarithmic", "linear_hardening", "power",
                                "saturating", "table",       "ramberg_osgood"};
  const std::string type = text.at("type");
  const auto found = std::find(std::begin(names), std::end(names), type);
  if (found == std::end(names)) throw Failure("material: the verifier knows no law of type " + type);
  law.form = static_cast<Law::Form>(found - std::begin(names));
  law.squared = text.value("argument", "norm") == "squared";
  if (law.form == Law::Form::table) {
    for (const auto& point : text.at("points")) {
      law.x.push_back(point.at(0).get<double>());
      law.s.push_back(point.at(1).get<double>());
    }
    return law;
  }
  if (law.form == Law::Form::linear) return law;
  if (law.form == Law::Form::ramberg_osgood) {
    law.x0 = deviator(text.at("sigma0").get<double>()) / (2 * law.shear);
    law.share = 3 * law.shear * Real(text.at("alpha").get<double>()) / young;
    law.parameter = text.at("n").get<double>();
    return law;
  }
  if (text.contains("x0")) {
    law.x0 = text.at("x0").get<double>();
  } else {
    law.x0 = deviator(text.at("yield_stress").get<double>()) / (2 * law.shear);
    if (law.squared) law.x0 *= law.x0;
  }
  for (const char* key : {"gamma", "n", "q"})
    if (text.contains(key)) law.parameter = text.at(key).get<double>();
  return law;
}

}  // namespace

Law read_law(const nlohmann::json& entry, bool may_lock) {
  Law law = read_form(entry);
  const bool locks = law.form != Law::Form::linear || entry.at("poisson").get<double>() > 0.45;
  law.bbar = entry.value("bbar", may_lock && locks);
  if (entry.contains("formulation")) law.mixed = law.bbar = entry.at("formulation") == "mixed";
  return law;
}

}  // namespace kacanov::verify
