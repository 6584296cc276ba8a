// SPDX-License-Identifier: BSD-3-Clause
// User-defined material laws: strains at the points, and operators with moduli that the caller computes.
#include <kacanov/operator.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "bodies.hpp"

using namespace kacanov;
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
