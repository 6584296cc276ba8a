// SPDX-License-Identifier: BSD-3-Clause
// The material laws against their definitions: derivative, energy, monotonicity, limits, curves of tension
// tests; laws of the caller.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include <kacanov/law.hpp>
#include <kacanov/operator.hpp>
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

namespace {

constexpr double steel_young = 210e3;

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
    Law law = elastic_law(steel_young, poisson);
    law.form = plastic_table(law, rows);
    CHECK(validate(law).empty());
    CHECK(strain_of(law, 100.0) == doctest::Approx(100.0 / steel_young).epsilon(1e-12));
    CHECK(strain_of(law, 250.0) == doctest::Approx(250.0 / steel_young).epsilon(1e-12));
    CHECK(strain_of(law, 275.0) == doctest::Approx(275.0 / steel_young + 0.005).epsilon(1e-12));
    CHECK(strain_of(law, 300.0) == doctest::Approx(300.0 / steel_young + 0.01).epsilon(1e-12));
    CHECK(strain_of(law, 400.0) == doctest::Approx(400.0 / steel_young + 0.1).epsilon(1e-12));
    CHECK(strain_of(law, 350.0) ==
          doctest::Approx(350.0 / steel_young + 0.06).epsilon(0.05));  // after a plateau
  }
}

TEST_CASE("one row is nearly perfect plasticity") {
  const std::array<std::array<double, 2>, 1> row{{{250, 0}}};
  Law law = elastic_law(steel_young, 0.3);
  law.form = plastic_table(law, row);
  CHECK(validate(law).empty());
  CHECK(law.plastic(1.001 * law.yield_strain()));
  const double x = 100.0 * law.yield_strain();
  CHECK(std::sqrt(1.5) * 2.0 * law.secant(x) * x == doctest::Approx(250.0).epsilon(1.1 * 99 * plateau_slope));
}

TEST_CASE("a tangent modulus is the slope beyond yield") {
  for (const double poisson : {0.0, 0.3, 0.49}) {
    Law law = elastic_law(steel_young, poisson);
    law.form = bilinear(law, 250.0, 2e3);
    CHECK(validate(law).empty());
    CHECK(strain_of(law, 240.0) == doctest::Approx(240.0 / steel_young).epsilon(1e-12));
    CHECK(strain_of(law, 290.0) == doctest::Approx(250.0 / steel_young + 40.0 / 2e3).epsilon(1e-12));
  }
}

TEST_CASE("Ramberg and Osgood's curve") {
  for (const double n : {1.5, 5.0, 30.0}) {
    CAPTURE(n);
    Law law = elastic_law(steel_young, 0.3);
    law.form = ramberg_osgood(law, 300.0, 3.0 / 7.0, n);
    CHECK(validate(law).empty());
    for (const double stress : {1e-3, 30.0, 200.0, 300.0, 400.0}) {
      const double plastic = 3.0 / 7.0 * 300.0 / steel_young * std::pow(stress / 300.0, n);
      CHECK(strain_of(law, stress) == doctest::Approx(stress / steel_young + plastic).epsilon(1e-12));
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

using test::difference;
using test::OwnedBody;

namespace {

/// A perturbed body of several laws with shuffled nodes.
OwnedBody crooked_body(ElementType type) {
  auto mesh = meshes::box(type, {7, 4, 4}, {2, 1, 1});
  meshes::jitter(mesh, cell(type).order == 2 ? 0.04 : 0.12, 1);
  meshes::shuffle(mesh, 2);
  return test::with_every_law(mesh, 3);
}

/// Returns an operator with this instruction set, or nothing where the processor or build lacks it.
template <class AnyOperator = Operator>
std::optional<AnyOperator> make(const Body& body, int threads, const std::string& set) {
  try {
    return AnyOperator(body, {threads, set});
  } catch (const std::invalid_argument&) {
    return {};
  }
}

/// Arbitrary moduli that belong to no law.
struct SomeModuli {
  std::vector<double> secant, derivative, energy;
  explicit SomeModuli(std::size_t points)
      : secant(test::random_vector(points, 4, 0.2)),
        derivative(test::random_vector(points, 5, 3.0)),
        energy(test::random_vector(points, 6, 1e-4)) {
    for (double& g : secant) g += 0.3;
  }
  PointModuli view() const { return {secant, derivative, energy}; }
};

/// Calls check(body, operator) for every element type, instruction set and number of threads.
template <class Check>
void for_every_operator(const Check& check) {
  for (const ElementType type : test::all_types) {
    const OwnedBody owned = crooked_body(type);
    for (const std::string set : {"plain", "avx2", "avx512"})
      for (const int threads : {1, 2}) {
        CAPTURE(static_cast<int>(type));
        CAPTURE(set);
        CAPTURE(threads);
        if (auto op = make(owned.body(), threads, set)) check(owned.body(), *op);
      }
  }
}

}  // namespace

TEST_CASE("x at the points is the norm of the deviator of the strain there") {
  for_every_operator([](const Body& body, Operator& op) {
    const auto u = test::random_vector(body.unknowns(), 7, 0.01);
    std::vector<double> x(body.secant_count()), strain(6 * x.size()), expected(x.size());
    op.strain(u, x);
    reference::strains(body, u, strain);
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double* e = &strain[6 * k];
      const double mean = (e[0] + e[1] + e[2]) / 3.0;
      double square = 2.0 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
      for (std::size_t c = 0; c < 3; ++c) square += (e[c] - mean) * (e[c] - mean);
      expected[k] = std::sqrt(square);
    }
    CHECK(difference(x, expected) < 1e-12);
    std::vector<double> g(x.size()), law(x.size());
    op.update(u);
    op.secant(g);
    for (std::size_t k = 0; k < x.size(); ++k)
      law[k] = body.law(k / points_per_element(body.mesh.type)).secant(x[k]);
    CHECK(difference(g, law) < 1e-13);
  });
}

TEST_CASE("residual, energy and tangent are those of the moduli that are given") {
  for_every_operator([](const Body& body, Operator& op) {
    const std::size_t n = body.unknowns();
    const SomeModuli some(body.secant_count());
    const PointModuli moduli = some.view();
    Body given = body;
    given.moduli = &moduli;
    const auto u = test::random_vector(n, 7, 0.01), x = test::random_vector(5 * n, 8);
    const auto first = std::span(x).first(n);
    std::vector<double> f(n), expected(n), y(n), before(n), many(5 * n),
        blocks(n * dimension(body.mesh.type)), expected_blocks(blocks.size());
    op.apply(first, before);
    const double energy = op.residual_energy(u, moduli, f);
    reference::residual(given, u, expected);
    CHECK(difference(f, expected) < 1e-12);
    CHECK(energy == doctest::Approx(reference::energy(given, u)).epsilon(1e-11));
    CHECK(op.residual_energy(u, moduli, {}) == energy);
    CHECK(op.residual_energy(u, {some.secant}, f) == 0.0);
    op.apply(first, y);
    CHECK(y == before);  // the frozen g does not enter

    op.update_tangent(u, moduli);
    op.apply_tangent(first, y);
    reference::apply_tangent(given, u, first, expected);
    CHECK(difference(y, expected) < 3e-7);  // the rank-one term is stored in single precision
    op.block_diagonal_tangent(blocks);
    reference::block_diagonal_tangent(given, u, expected_blocks);
    CHECK(difference(blocks, expected_blocks) < 3e-7);
    op.apply_tangent_many(x, many, 5);
    for (std::size_t v = 0; v < 5; ++v) {
      op.apply_tangent(std::span(x).subspan(v * n, n), y);
      CHECK(difference(std::span(many).subspan(v * n, n), y) < 1e-13);
    }

    auto single = make<FloatOperator>(body, 2, std::string(op.instruction_set()));
    REQUIRE(single);
    const std::vector<float> xf(first.begin(), first.end());
    std::vector<float> yf(n);
    CHECK_THROWS_AS(single->apply_tangent(xf, yf), std::logic_error);
    single->take_tangent(op);
    op.apply_tangent(first, y);
    single->apply_tangent(xf, yf);
    CHECK(difference(yf, y) < 2e-5);
    CHECK_THROWS_AS(op.update_tangent(u, {some.secant}), std::invalid_argument);
  });
}

TEST_CASE("a body without elements, or without nodes, is the zero operator") {
  const std::vector<Law> laws{elastic_law(1.0, 0.3)};
  for (const ElementType type : test::all_types)
    for (const std::size_t nodes : {0, 500}) {
      CAPTURE(static_cast<int>(type));
      CAPTURE(nodes);
      const auto coordinates = test::random_vector(nodes * dimension(type), 1);
      const Body body{{type, coordinates, {}}, laws, {}};
      OperatorOptions options;
      options.threads = 2;
      Operator op(body, options);
      std::vector<double> y(coordinates.size(), 1.0);
      CHECK(op.apply_dot(coordinates, y) == 0.0);
      CHECK(y == std::vector<double>(coordinates.size(), 0.0));
      op.update_tangent(coordinates);
      op.diagonal_tangent(y);
      CHECK(op.residual_energy_update(coordinates, y) == 0.0);
    }
}
