// SPDX-License-Identifier: BSD-3-Clause
// The material laws, checked against their definitions: derivative, energy, monotonicity, limits.
#include <kacanov/law.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "bodies.hpp"

using namespace kacanov;

namespace {

std::vector<Law> both_arguments() {
  std::vector<Law> laws = test::every_law();
  const std::size_t count = laws.size();
  for (std::size_t i = 0; i < count; ++i) {
    laws.push_back(laws[i]);
    laws.back().argument = Law::Argument::squared;
  }
  return laws;
}

/// Strains on both sides of the yield strain that avoid the kinks (x0 and the points of the table).
std::vector<double> strains(const Law& law) {
  std::vector<double> x;
  for (double a = 1.07e-4; a < 1.0; a *= 1.37)
    x.push_back(law.argument == Law::Argument::squared ? std::sqrt(a) : a);
  return x;
}

}  // namespace

TEST_CASE("elastic constants") {
  const Law law = elastic_law(1.0, 0.3);
  CHECK(law.bulk == doctest::Approx(1.0 / 1.2));
  CHECK(law.shear == doctest::Approx(1.0 / 2.6));
}

TEST_CASE("g starts at mu, never grows, and its derivative is the slope") {
  for (const Law& law : both_arguments()) {
    CAPTURE(law.form.index());
    CAPTURE(static_cast<int>(law.argument));
    CHECK(law.secant(0.0) == doctest::Approx(law.shear));
    CHECK(law.secant_derivative(0.0) == 0.0);
    double last = law.secant(0.0);
    for (const double x : strains(law)) {
      CAPTURE(x);
      CHECK(law.secant(x) <= last * (1 + 1e-14));
      last = law.secant(x);
      const double h = 1e-6 * x;
      const double slope = (law.secant(x + h) - law.secant(x - h)) / (2 * h);
      CHECK(law.secant_derivative(x) == doctest::Approx(slope).epsilon(1e-6).scale(law.shear / x));
    }
  }
}

TEST_CASE("the energy is the integral of g x") {
  for (const Law& law : both_arguments()) {
    CAPTURE(law.form.index());
    CAPTURE(static_cast<int>(law.argument));
    CHECK(law.energy(0.0) == 0.0);
    double integral = 0.0, from = 0.0;
    for (const double x : strains(law)) {
      const int pieces = 4000;  // midpoint rule, accurate enough across the kinks
      for (int i = 0; i < pieces; ++i) {
        const double s = from + (x - from) * (i + 0.5) / pieces;
        integral += law.secant(s) * s * (x - from) / pieces;
      }
      from = x;
      CAPTURE(x);
      CHECK(law.energy(x) == doctest::Approx(integral).epsilon(1e-6));
    }
  }
}

TEST_CASE("stress grows with strain where the argument is the norm") {
  for (const Law& law : test::every_law()) {
    CAPTURE(law.form.index());
    double last = 0.0;
    for (double x = 1e-5; x < 10.0; x *= 1.05) {
      CAPTURE(x);
      CHECK_FALSE(law.softens(x));
      if (x > 0.1) continue;  // the saturating law has reached its limit to machine precision
      CHECK(law.secant(x) * x > last);
      last = law.secant(x) * x;
    }
  }
}

TEST_CASE("the paper's squared argument softens beyond e x0") {
  Law law = test::every_law()[1];
  law.argument = Law::Argument::squared;
  const double limit = std::sqrt(std::exp(1.0) * std::get<laws::Logarithmic>(law.form).x0);
  CHECK_FALSE(law.softens(0.99 * limit));
  CHECK(law.softens(1.01 * limit));
}

TEST_CASE("plastic means beyond the yield strain") {
  for (const Law& law : test::every_law()) {
    CHECK_FALSE(law.plastic(0.0));
    CHECK_FALSE(law.plastic(0.0099));
    CHECK(law.plastic(0.0101) == !law.linear());
  }
}

TEST_CASE("a table meets its points and goes on with the last slope") {
  const Law law = test::every_law()[5];
  const auto& [x, s] = std::get<laws::Table>(law.form);
  for (std::size_t i = 1; i < x.size(); ++i) CHECK(2 * law.secant(x[i]) * x[i] == doctest::Approx(s[i]));
  const double slope = (s[3] - s[2]) / (x[3] - x[2]);
  CHECK(2 * law.secant(0.2) * 0.2 == doctest::Approx(s[3] + slope * (0.2 - x[3])));
}

TEST_CASE("a table of one piece goes on as it began") {
  for (const auto argument : {Law::Argument::norm, Law::Argument::squared}) {
    Law law = elastic_law(1.0, 0.3);
    law.argument = argument;
    law.form = laws::Table{{0.0, 0.01}, {0.0, 0.02 * law.shear}};
    for (const double x : {0.001, 0.1, 0.5}) {
      CHECK(law.secant(x) == doctest::Approx(law.shear));
      CHECK(law.energy(x) == doctest::Approx(0.5 * law.shear * x * x));
    }
  }
}

TEST_CASE("a saturating law with a sharp knee stays finite") {
  constexpr double x0 = 0.01;
  Law law = test::every_law()[4];
  law.argument = Law::Argument::squared;
  law.form = laws::Saturating{x0, 1e-4};
  const double x = 0.2;  // argument 4 x0, for which e^{1/q} alone would overflow
  // g a quickly approaches mu x0 (1 + q), so ½∫ g da ≈ ½ mu x0 (1 + (1 + q) ln 4).
  CHECK(law.energy(x) == doctest::Approx(0.5 * law.shear * x0 * (1 + 1.0001 * std::log(4.0))).epsilon(1e-6));
}

TEST_CASE("validate names the parameter at fault in the words of the case file") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Law& law : both_arguments()) CHECK(validate(law).empty());
  const auto fault = [](const Law::Form& form) {
    Law law = elastic_law(1.0, 0.3);
    law.form = form;
    return validate(law);
  };
  CHECK(fault(laws::Logarithmic{0.0}) == "x0: expected a number > 0, got 0");
  CHECK(fault(laws::Logarithmic{nan}).starts_with("x0: "));
  CHECK(fault(laws::LinearHardening{0.01, 0.0}) == "gamma: expected a number > 0 and ≤ 1, got 0");
  CHECK(fault(laws::LinearHardening{0.01, 1.0}).empty());
  CHECK(fault(laws::Power{0.01, 1.5}) == "n: expected a number > 0 and ≤ 1, got 1.5");
  CHECK(fault(laws::Saturating{0.01, -2.0}) == "q: expected a number > 0, got -2");
  CHECK(fault(laws::Table{}).starts_with("points: expected a list"));
  CHECK(fault(laws::Table{{0.1, 1}, {0, 1}}) == "points[0]: expected [0, 0] as the first point");
  CHECK(fault(laws::Table{{0, 1, 1}, {0, 1, 2}}).starts_with("points[2][0]: expected a strain above"));
  CHECK(fault(laws::Table{{0, 1, 2}, {0, 1, 1}}).starts_with("points[2][1]: expected a stress above"));
  CHECK(fault(laws::Table{{0, 1, 2}, {0, 1, 3}}).starts_with("points[2]: expected a secant s/x"));
  CHECK(validate(test::stiffening_law()).starts_with("points[2]: "));
  Law law = elastic_law(1.0, 0.3);
  law.shear = -1.0;
  CHECK(validate(law) == "shear: expected a number > 0, got -1");
  law.bulk = nan;
  CHECK(validate(law).starts_with("bulk: "));
}
