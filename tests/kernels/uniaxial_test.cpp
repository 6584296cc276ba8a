// SPDX-License-Identifier: BSD-3-Clause
// Laws from curves of tension tests: under uniaxial stress a point reproduces its curve.
#include <doctest/doctest.h>

#include <cmath>

#include <kacanov/law.hpp>

using namespace kacanov;

namespace {

constexpr double young = 210e3;

/// Returns the axial strain of a uniaxial stress under the law, ε = tr ε/3 + dev ε, with x found by
/// bisection.
double strain_of(const Law& law, double stress) {
  double low = 0.0, high = 10.0;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * (low + high);
    (std::sqrt(1.5) * 2.0 * law.secant(x) * x < stress ? low : high) = x;
  }
  return stress / (9.0 * law.bulk) + std::sqrt(2.0 / 3.0) * low;
}

}  // namespace

TEST_CASE("a table of stress and plastic strain is met at and between its rows") {
  const std::array<std::array<double, 2>, 4> rows{{{250, 0}, {300, 0.01}, {300, 0.02}, {400, 0.1}}};
  for (const double poisson : {0.0, 0.3, 0.49}) {
    Law law = elastic_law(young, poisson);
    law.form = plastic_table(law, rows);
    CHECK(validate(law).empty());
    CHECK(strain_of(law, 100.0) == doctest::Approx(100.0 / young).epsilon(1e-12));
    CHECK(strain_of(law, 250.0) == doctest::Approx(250.0 / young).epsilon(1e-12));
    CHECK(strain_of(law, 275.0) == doctest::Approx(275.0 / young + 0.005).epsilon(1e-12));
    CHECK(strain_of(law, 300.0) == doctest::Approx(300.0 / young + 0.01).epsilon(1e-12));
    CHECK(strain_of(law, 400.0) == doctest::Approx(400.0 / young + 0.1).epsilon(1e-12));
    CHECK(strain_of(law, 350.0) == doctest::Approx(350.0 / young + 0.06).epsilon(0.05));  // after a plateau
  }
}

TEST_CASE("one row is nearly perfect plasticity") {
  const std::array<std::array<double, 2>, 1> row{{{250, 0}}};
  Law law = elastic_law(young, 0.3);
  law.form = plastic_table(law, row);
  CHECK(validate(law).empty());
  CHECK(law.plastic(1.001 * law.yield_strain()));
  const double x = 100.0 * law.yield_strain();
  CHECK(std::sqrt(1.5) * 2.0 * law.secant(x) * x == doctest::Approx(250.0).epsilon(1.1 * 99 * plateau_slope));
}

TEST_CASE("a tangent modulus is the slope beyond yield") {
  for (const double poisson : {0.0, 0.3, 0.49}) {
    Law law = elastic_law(young, poisson);
    law.form = bilinear(law, 250.0, 2e3);
    CHECK(validate(law).empty());
    CHECK(strain_of(law, 240.0) == doctest::Approx(240.0 / young).epsilon(1e-12));
    CHECK(strain_of(law, 290.0) == doctest::Approx(250.0 / young + 40.0 / 2e3).epsilon(1e-12));
  }
}

TEST_CASE("Ramberg and Osgood's curve") {
  for (const double n : {1.5, 5.0, 30.0}) {
    CAPTURE(n);
    Law law = elastic_law(young, 0.3);
    law.form = ramberg_osgood(law, 300.0, 3.0 / 7.0, n);
    CHECK(validate(law).empty());
    for (const double stress : {1e-3, 30.0, 200.0, 300.0, 400.0}) {
      const double plastic = 3.0 / 7.0 * 300.0 / young * std::pow(stress / 300.0, n);
      CHECK(strain_of(law, stress) == doctest::Approx(stress / young + plastic).epsilon(1e-12));
    }
    CHECK(law.secant(0.0) == law.shear);
    CHECK_FALSE(law.plastic(0.999 * law.proof_strain()));
    CHECK(law.plastic(1.001 * law.proof_strain()));
    double integral = 0.0, from = 0.0;
    for (const double x : {1e-4, 1e-3, 1e-2, 1e-1}) {
      CAPTURE(x);
      const double h = 1e-6 * x, slope = (law.secant(x + h) - law.secant(x - h)) / (2 * h);
      CHECK(law.secant_derivative(x) == doctest::Approx(slope).epsilon(1e-6).scale(law.shear / x));
      CHECK_FALSE(law.softens(x));
      constexpr int pieces = 4000;
      for (int i = 0; i < pieces; ++i) {
        const double s = from + (x - from) * (i + 0.5) / pieces;
        integral += law.secant(s) * s * (x - from) / pieces;
      }
      from = x;
      CHECK(law.energy(x) == doctest::Approx(integral).epsilon(1e-6));
    }
  }
}

TEST_CASE("what is wrong with a Ramberg–Osgood law") {
  Law law = elastic_law(1.0, 0.3);
  law.form = laws::RambergOsgood{0.0, 1.0, 2.0};
  CHECK(validate(law) == "x0: expected a number > 0, got 0");
  law.form = laws::RambergOsgood{0.01, -1.0, 2.0};
  CHECK(validate(law) == "a: expected a number > 0, got -1");
  law.form = laws::RambergOsgood{0.01, 1.0, 1.0};
  CHECK(validate(law) == "n: expected a number > 1, got 1");
  law.form = laws::RambergOsgood{0.01, 1.0, 5.0};
  law.argument = Law::Argument::squared;
  CHECK(validate(law).starts_with("argument: expected \"norm\""));
}
