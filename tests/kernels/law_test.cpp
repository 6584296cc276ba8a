// SPDX-License-Identifier: BSD-3-Clause
// The laws against their own definitions: derivative, energy, monotony, limits.
#include <kacanov/law.hpp>

#include <doctest/doctest.h>

#include <cmath>

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

/// Strains on both sides of the yield strain, kinks (x0 and the table's points) avoided.
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
    CAPTURE(static_cast<int>(law.kind));
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
    CAPTURE(static_cast<int>(law.kind));
    CAPTURE(static_cast<int>(law.argument));
    CHECK(law.energy(0.0) == 0.0);
    double integral = 0.0, from = 0.0;
    for (const double x : strains(law)) {
      const int pieces = 4000;  // midpoint rule; exact enough across the kinks
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
    CAPTURE(static_cast<int>(law.kind));
    double last = 0.0;
    for (double x = 1e-5; x < 10.0; x *= 1.05) {
      CAPTURE(x);
      CHECK_FALSE(law.softens(x));
      if (x > 0.1) continue;  // the saturating law has reached its limit to the last digit
      CHECK(law.secant(x) * x > last);
      last = law.secant(x) * x;
    }
  }
}

TEST_CASE("the paper's squared argument softens beyond e x0") {
  Law law = test::every_law()[1];
  law.argument = Law::Argument::squared;
  const double limit = std::sqrt(std::exp(1.0) * law.x0);
  CHECK_FALSE(law.softens(0.99 * limit));
  CHECK(law.softens(1.01 * limit));
}

TEST_CASE("plastic means beyond the yield strain") {
  for (const Law& law : test::every_law()) {
    CHECK_FALSE(law.plastic(0.0));
    CHECK_FALSE(law.plastic(0.0099));
    CHECK(law.plastic(0.0101) == (law.kind != Law::Kind::linear));
  }
}

TEST_CASE("a table meets its points and goes on with the last slope") {
  const Law law = test::every_law()[5];
  for (std::size_t i = 1; i < law.table_x.size(); ++i)
    CHECK(2 * law.secant(law.table_x[i]) * law.table_x[i] == doctest::Approx(law.table_s[i]));
  const double slope = (law.table_s[3] - law.table_s[2]) / (law.table_x[3] - law.table_x[2]);
  CHECK(2 * law.secant(0.2) * 0.2 == doctest::Approx(law.table_s[3] + slope * (0.2 - law.table_x[3])));
}

TEST_CASE("a saturating law with a sharp knee stays finite") {
  Law law = test::every_law()[4];
  law.argument = Law::Argument::squared;
  law.q = 1e-4;
  const double x = 0.2;  // argument 4 x0: e^{1/q} alone would overflow
  // g a → mu x0 (1 + q) at once, so ½∫ g da ≈ ½ mu x0 (1 + (1 + q) ln 4).
  CHECK(law.energy(x) ==
        doctest::Approx(0.5 * law.shear * law.x0 * (1 + 1.0001 * std::log(4.0))).epsilon(1e-6));
}
