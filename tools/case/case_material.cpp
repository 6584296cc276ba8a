// SPDX-License-Identifier: BSD-3-Clause
// The `material` entries of a case: elastic constants and laws.
#include "case/case_material.hpp"

#include <cmath>
#include <sstream>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

bool positive(double v) { return v > 0.0; }

/// x0, or the yield stress it follows from: 2 mu x0 = sqrt(2/3) sigma_y for the norm.
double yield_strain(const Object& object, const Law& law) {
  if (object.only_one_of({"x0", "yield_stress"}) == "x0")
    return object.required("x0").number("a number > 0", positive);
  const double stress = object.required("yield_stress").number("a number > 0", positive);
  const double norm = std::sqrt(2.0 / 3.0) * stress / (2.0 * law.shear);
  return law.argument == Law::Argument::squared ? norm * norm : norm;
}

void parse_table(const Node& node, Law& law, std::vector<std::string>& warnings) {
  const char* wanted = "a list of pairs [x, s] from [0, 0] on";
  for (const Node& point : node.list(wanted)) {
    const std::vector<Node> pair = point.list("a pair [x, s]");
    if (pair.size() != 2) point.expected("a pair [x, s]");
    const double x = pair[0].number(), s = pair[1].number();
    if (law.table_x.empty()) {
      if (x != 0.0 || s != 0.0) point.expected("[0, 0] as the first point");
    } else {
      if (!(x > law.table_x.back())) pair[0].expected("a strain above that of the point before");
      if (!(s > law.table_s.back())) pair[1].expected("a stress above that of the point before");
      const bool second = law.table_x.size() == 1;
      // A straight line through the origin, written with rounded numbers, is no increase.
      if (!second && s / x > law.table_s.back() / law.table_x.back() * (1.0 + 1e-9)) {
        point.expected("a secant s/x not above that of the point before");
      }
    }
    law.table_x.push_back(x);
    law.table_s.push_back(s);
  }
  if (law.table_x.size() < 2) node.expected(wanted);
  const double elastic = 2.0 * law.shear, slope = law.table_s[1] / law.table_x[1];
  if (law.argument == Law::Argument::norm && std::abs(slope - elastic) > 0.01 * elastic) {
    std::ostringstream text;
    text << node.path() << ": the table starts with the slope " << slope
         << ", young and poisson give 2 mu = " << elastic;
    warnings.push_back(text.str());
  }
}

}  // namespace

Law parse_law(double young, double poisson, const Node& node, std::vector<std::string>& warnings) {
  // Any law's key passes here, so that a wrong type is reported before keys that do not go with it.
  const Object any(node, {"type", "argument", "x0", "yield_stress", "gamma", "n", "q", "points"});
  constexpr std::array<Law::Kind, 6> kinds{Law::Kind::linear,           Law::Kind::logarithmic,
                                           Law::Kind::linear_hardening, Law::Kind::power,
                                           Law::Kind::saturating,       Law::Kind::table};
  Law law = elastic_law(young, poisson);
  law.kind = kinds[any.required("type").choice(
      {"linear", "logarithmic", "linear_hardening", "power", "saturating", "table"})];
  if (const auto argument = any.optional("argument")) {
    law.argument = argument->choice({"norm", "squared"}) == 0 ? Law::Argument::norm : Law::Argument::squared;
  }
  switch (law.kind) {
    case Law::Kind::linear: Object(node, {"type", "argument"}); break;
    case Law::Kind::logarithmic: {
      const Object object(node, {"type", "argument", "x0", "yield_stress"});
      law.x0 = yield_strain(object, law);
      break;
    }
    case Law::Kind::linear_hardening: {
      const Object object(node, {"type", "argument", "x0", "yield_stress", "gamma"});
      law.x0 = yield_strain(object, law);
      // At 0 the displacement would not be unique.
      law.gamma = object.required("gamma").number("a number > 0 and ≤ 1",
                                                  [](double v) { return v > 0.0 && v <= 1.0; });
      break;
    }
    case Law::Kind::power: {
      const Object object(node, {"type", "argument", "x0", "yield_stress", "n"});
      law.x0 = yield_strain(object, law);
      law.n =
          object.required("n").number("a number > 0 and ≤ 1", [](double v) { return v > 0.0 && v <= 1.0; });
      break;
    }
    case Law::Kind::saturating: {
      const Object object(node, {"type", "argument", "x0", "yield_stress", "q"});
      law.x0 = yield_strain(object, law);
      law.q = object.required("q").number("a number > 0", positive);
      break;
    }
    case Law::Kind::table: {
      const Object object(node, {"type", "argument", "points"});
      parse_table(object.required("points"), law, warnings);
      break;
    }
  }
  return law;
}

}  // namespace kacanov
