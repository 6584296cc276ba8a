// SPDX-License-Identifier: BSD-3-Clause
// Plane stress and axisymmetry: consistency of energy, force and tangent, and the fast operator against the
// reference.
#include <kacanov/operator.hpp>

#include <doctest/doctest.h>

#include <array>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "bodies.hpp"
#include "law/plane_stress.hpp"
#include "reference/matrix.hpp"

using namespace kacanov;
using test::difference;
using test::OwnedBody;

namespace {

constexpr std::array planes{PlaneState::stress, PlaneState::axisymmetric};
constexpr std::array flat_types{ElementType::tri3, ElementType::quad4};

/// A body in 2D with every law, touching the axis or away from it.
struct PlaneBody {
  OwnedBody owned;
  PlaneState plane;
  std::size_t elements = 0;  ///< only the first ones; 0: all

  Body body() const {
    Body body = owned.body();
    body.mesh.plane = plane;
    if (elements > 0) {
      body.mesh.connectivity = body.mesh.connectivity.first(
          elements * static_cast<std::size_t>(nodes_per_element(body.mesh.type)));
      body.law_of_element = body.law_of_element.first(elements);
    }
    return body;
  }
};

PlaneBody plane_body(ElementType type, PlaneState plane, double inner, std::size_t elements = 0) {
  meshes::OwnedMesh mesh = meshes::box(type, {7, 5, 1}, {1.5, 1.0, 1.0});
  if (inner > 0.0) meshes::jitter(mesh, 0.12, 3);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2) mesh.coordinates[i] += inner;
  OwnedBody owned{std::move(mesh), test::every_law(), {}};
  for (std::size_t i = 1; plane != PlaneState::stress && cell(type).mean_dilatation && i < owned.laws.size();
       i += 2)
    owned.laws[i].mean_dilatation = true;
  for (std::size_t e = 0; e < owned.mesh.view().element_count(); ++e)
    owned.law_of_element.push_back(static_cast<std::uint16_t>((e * 7) % owned.laws.size()));
  return {std::move(owned), plane, elements};
}

template <class Check>
void for_every_plane_body(Check&& check) {
  for (const ElementType type : flat_types)
    for (const PlaneState plane : planes)
      for (const double inner : {0.0, 0.3})
        for (const std::size_t elements : {0, 3, 17}) {
          if (inner == 0.0 && elements > 0) continue;
          const PlaneBody of = plane_body(type, plane, inner, elements);
          CAPTURE(cell(type).name);
          CAPTURE(static_cast<int>(plane));
          CAPTURE(inner);
          CAPTURE(elements);
          check(of.body());
        }
}

template <class AnyOperator, class Check>
void for_every_plane_operator(const Body& body, Check&& check) {
  for (const std::string set : {"plain", "avx2", "avx512"})
    for (const int threads : {1, 2}) {
      CAPTURE(set);
      CAPTURE(threads);
      std::unique_ptr<AnyOperator> op;
      try {
        op = std::make_unique<AnyOperator>(body, OperatorOptions{threads, set});
      } catch (const std::invalid_argument&) {
        continue;  // the processor lacks this instruction set
      }
      check(*op);
    }
}

template <class Real>
std::vector<Real> as(const std::vector<double>& v) {
  return {v.begin(), v.end()};
}

/// Compares every product of a fast operator with the reference, within `tolerance`.
template <class Real>
void compare(const Body& body, double tolerance) {
  const std::size_t n = body.unknowns();
  const auto u = test::random_vector(n, 5, 0.01), x = test::random_vector(n, 6);
  std::vector<double> g(body.secant_count()), y(n), t(n), f(n), blocks(2 * n), tangent_blocks(2 * n), d(n);
  reference::secant(body, u, g);
  reference::apply(body, g, x, y);
  reference::apply_tangent(body, u, x, t);
  reference::residual(body, u, f);
  reference::block_diagonal(body, g, blocks);
  reference::block_diagonal_tangent(body, u, tangent_blocks);
  reference::diagonal(body, g, d);
  const double energy = reference::energy(body, u);
  const auto su = as<Real>(u), sx = as<Real>(x);
  for_every_plane_operator<BasicOperator<Real>>(body, [&](BasicOperator<Real>& op) {
    std::vector<Real> out(n), out_blocks(2 * n);
    std::vector<double> out_g(g.size());
    op.update_tangent(su);
    op.secant(out_g);
    CHECK(difference(out_g, g) < tolerance);
    op.apply(sx, out);
    CHECK(difference(out, y) < tolerance);
    op.apply_tangent(sx, out);
    CHECK(difference(out, t) < std::max(tolerance, 1e-6));  // the rank-one term is stored in single precision
    op.residual(su, out);
    CHECK(difference(out, f) < tolerance);
    CHECK(op.energy(su) == doctest::Approx(energy).epsilon(tolerance));
    op.block_diagonal(out_blocks);
    CHECK(difference(out_blocks, blocks) < tolerance);
    op.block_diagonal_tangent(out_blocks);
    CHECK(difference(out_blocks, tangent_blocks) < std::max(tolerance, 1e-6));
    op.diagonal(out);
    CHECK(difference(out, d) < tolerance);
    std::vector<Real> many_x, many(3 * n), expected;
    for (int v = 0; v < 3; ++v) many_x.insert(many_x.end(), sx.begin(), sx.end());
    op.apply_many(many_x, many, 3);
    for (int v = 0; v < 3; ++v)
      CHECK(difference(std::span(many).subspan(static_cast<std::size_t>(v) * n, n), y) < tolerance);
  });
}

/// A unit translation of all nodes along `axis`.
std::vector<double> translation(const Body& body, std::size_t axis) {
  std::vector<double> u(body.unknowns(), 0.0);
  for (std::size_t i = axis; i < u.size(); i += 2) u[i] = 1.0;
  return u;
}

}  // namespace

TEST_CASE("in plane stress and round an axis the fast operator does what the reference does") {
  for_every_plane_body([](const Body& body) {
    compare<double>(body, 1e-12);
    if (body.mesh.element_count() > 17) compare<float>(body, 2e-4);
  });
}

TEST_CASE("in plane stress and round an axis force is the energy's derivative and the tangent the force's") {
  for (const ElementType type : flat_types)
    for (const PlaneState plane : planes) {
      CAPTURE(cell(type).name);
      CAPTURE(static_cast<int>(plane));
      const PlaneBody of = plane_body(type, plane, 0.2);
      const Body body = of.body();
      const std::size_t n = body.unknowns();
      const auto u = test::random_vector(n, 5, 0.01), x = test::random_vector(n, 6, 0.01);
      const double h = 1e-5;
      std::vector<double> ahead = u, back = u, f(n), f_ahead(n), f_back(n), t(n), g(body.secant_count()),
                          y(n);
      for (std::size_t i = 0; i < n; ++i) ahead[i] += h * x[i], back[i] -= h * x[i];
      reference::residual(body, u, f);
      const double slope = (reference::energy(body, ahead) - reference::energy(body, back)) / (2.0 * h);
      CHECK(slope == doctest::Approx(test::dot(f, x)).epsilon(1e-6));
      reference::residual(body, ahead, f_ahead);
      reference::residual(body, back, f_back);
      for (std::size_t i = 0; i < n; ++i) f_ahead[i] = (f_ahead[i] - f_back[i]) / (2.0 * h);
      reference::apply_tangent(body, u, x, t);
      CHECK(difference(t, f_ahead) < 1e-4);  // the laws have kinks
      // The operator frozen at u has the same force there, so that solutions of R(u) = F are fixed points of
      // Kačanov's method.
      reference::secant(body, u, g);
      reference::apply(body, g, u, y);
      CHECK(difference(y, f) < 1e-12);
      // The frozen energy is a majorant: 2 (E(v) − E(u)) ≤ vᵀ B v − uᵀ B u, so every step decreases the
      // energy.
      reference::apply(body, g, ahead, y);
      const double frozen = test::dot(y, ahead) - test::dot(f, u);
      CHECK(2.0 * (reference::energy(body, ahead) - reference::energy(body, u)) <=
            frozen + 1e-12 * std::abs(frozen));
    }
}

TEST_CASE(
    "in plane stress and round an axis matrices are symmetric and closed forms those of the reference") {
  for (const ElementType type : flat_types)
    for (const PlaneState plane : planes) {
      const PlaneBody of = plane_body(type, plane, 0.2);
      const Body body = of.body();
      const std::size_t points = points_per_element(type), width = nodes_per_element(type) * std::size_t{2};
      const auto u = test::random_vector(body.unknowns(), 8, 0.02);
      std::vector<double> g(body.secant_count()), plain(width * width), closed(width * width),
          transposed(width * width);
      reference::secant(body, u, g);
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const auto own = std::span(g).subspan(e * points, points);
        reference::element_matrix(body, e, own, plain);
        element_stiffness(body, e, own, closed);
        CHECK(difference(closed, plain) < 1e-13);
        reference::element_tangent(body, e, u, plain);
        for (std::size_t i = 0; i < width; ++i)
          for (std::size_t k = 0; k < width; ++k) transposed[i * width + k] = plain[k * width + i];
        CHECK(difference(transposed, plain) < 1e-12);
      }
    }
}

TEST_CASE(
    "a free strain in plane stress: stress follows from what is left of the strain, fast and plain alike") {
  for (const ElementType type : flat_types) {
    CAPTURE(cell(type).name);
    const PlaneBody of = plane_body(type, PlaneState::stress, 0.2);
    Body body = of.body();
    const std::size_t n = body.unknowns();
    std::vector<double> longer;
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e)
      longer.push_back(0.01 * std::sin(static_cast<double>(e)));
    body.free_strain = longer;
    const auto u = test::random_vector(n, 5, 0.01), x = test::random_vector(n, 6, 0.01);
    std::vector<double> f(n), ahead = u, back = u, out(n), g(body.secant_count()), out_g(g.size()), t(n);
    reference::residual(body, u, f);
    reference::secant(body, u, g);
    reference::apply_tangent(body, u, x, t);
    const double energy = reference::energy(body, u), h = 1e-5;
    for (std::size_t i = 0; i < n; ++i) ahead[i] += h * x[i], back[i] -= h * x[i];
    CHECK((reference::energy(body, ahead) - reference::energy(body, back)) / (2.0 * h) ==
          doctest::Approx(test::dot(f, x)).epsilon(1e-6));
    for_every_plane_operator<Operator>(body, [&](Operator& op) {
      op.set_free_strain(longer);
      op.update_tangent(u);
      op.secant(out_g);
      CHECK(difference(out_g, g) < 1e-12);
      op.apply_tangent(x, out);
      CHECK(difference(out, t) < 1e-6);
      CHECK(op.residual_energy_update(u, out) == doctest::Approx(energy).epsilon(1e-12));
      CHECK(difference(out, f) < 1e-12);
      op.set_free_strain({});
      op.residual(u, out);
      CHECK(difference(out, f) > 1e-3);
    });
    // A body strained by exactly its free strain has no stress, and its total strain is the free strain.
    const std::vector<double> same(longer.size(), 0.03);
    body.free_strain = same;
    std::vector<double> grown(body.mesh.coordinates.begin(), body.mesh.coordinates.end());
    for (double& entry : grown) entry *= 0.03;
    reference::residual(body, grown, out);
    CHECK(std::sqrt(test::dot(out, out)) < 1e-14 * std::sqrt(test::dot(f, f)) + 1e-15);
    CHECK(reference::energy(body, grown) < 1e-25);
    std::vector<double> strain(6 * body.secant_count());
    reference::strains(body, grown, strain);
    for (std::size_t i = 0; i < strain.size(); ++i)
      CHECK(std::abs(strain[i] - (i % 6 < 3 ? 0.03 : 0.0)) < 1e-15);
    // In the elastic body the free strain acts as a load.
    std::vector<Law> linear(of.owned.laws.size(), elastic_law(1.0, 0.3));
    body.laws = linear;
    reference::residual(body, u, f);
    reference::free_force(body, out);
    for (std::size_t i = 0; i < n; ++i) f[i] += out[i];
    body.free_strain = {};
    reference::residual(body, u, out);
    CHECK(difference(f, out) < 1e-12);
  }
  const PlaneBody of = plane_body(ElementType::tri3, PlaneState::axisymmetric, 0.2);
  Operator round(of.body());
  CHECK_THROWS_WITH_AS(round.set_free_strain({}), "free strain is for plane stress", std::logic_error);
}

TEST_CASE("in plane stress nothing is lost where the material is nearly incompressible") {
  for (const ElementType type : flat_types)
    for (const double poisson : {0.3, 0.499, 0.4999999, -0.9}) {
      CAPTURE(poisson);
      PlaneBody of = plane_body(type, PlaneState::stress, 0.2);
      for (Law& law : of.owned.laws) law = elastic_law(1.0, poisson);
      const Body body = of.body();
      const std::size_t n = body.unknowns();
      std::vector<double> g(body.secant_count()), d(n), f(n), y(n);
      reference::secant(body, std::vector<double>(n, 0.0), g);
      reference::diagonal(body, g, d);
      for (double& entry : d) entry *= 1e-15;
      const double known = std::sqrt(test::dot(d, d));  // scale of rounding errors
      for (const std::size_t axis : {0, 1}) {
        reference::residual(body, translation(body, axis), f);
        CHECK(std::sqrt(test::dot(f, f)) < known);
      }
      // No digits are lost with the true law or with the frozen one.
      const auto u = test::random_vector(n, 5);
      Operator op(body);
      op.apply(u, y);
      reference::residual(body, u, f);
      CHECK(difference(f, y) < 1e-14);
      reference::apply(body, g, u, f);
      CHECK(difference(f, y) < 1e-14);
    }
}

TEST_CASE("round an axis only the translation along it strains nothing") {
  for (const ElementType type : flat_types) {
    const PlaneBody of = plane_body(type, PlaneState::axisymmetric, 0.2);
    const Body body = of.body();
    CHECK(reference::energy(body, translation(body, 1)) < 1e-25);
    CHECK(reference::energy(body, translation(body, 0)) > 1e-3);
    std::vector<double> volume(body.mesh.element_count());
    reference::volumes(body, volume);
    double all = 0.0;
    for (const double v : volume) all += v;
    const PlaneBody straight = plane_body(type, PlaneState::axisymmetric, 0.0);
    std::vector<double> of_disc(straight.body().mesh.element_count());
    reference::volumes(straight.body(), of_disc);
    double disc = 0.0;
    for (const double v : of_disc) disc += v;
    CHECK(disc == doctest::Approx(std::numbers::pi * 1.5 * 1.5));
    CHECK(all > disc);
  }
}

TEST_CASE("across plane stress no stress acts, and the uniaxial curve is that of the law") {
  for (const Law& law : test::every_law())
    for (const double xx : {-0.3, -0.005, 0.004, 0.02, 0.5})
      for (const double yy : {-0.01, 0.0, 0.1}) {
        const double xy = 0.3 * xx, zz = transverse_strain(law, xx, yy, xy), third = (xx + yy + zz) / 3.0;
        const double a = xx - third, b = yy - third, c = zz - third;
        const double g = law.secant(std::sqrt(a * a + b * b + c * c + 2.0 * xy * xy));
        const double mean = law.bulk * (xx + yy + zz), size = law.bulk * std::abs(xx);
        CHECK(std::abs(mean + 2.0 * g * c) < 1e-14 * size);
        // The same stress, written with the effective bulk modulus of plane stress.
        const double bulk = plane_stress_bulk(law.bulk, g), plane = xx + yy;
        CHECK(std::abs(bulk * plane + 2.0 * g * (xx - plane / 3.0) - mean - 2.0 * g * a) < 1e-13 * size);
      }
}

TEST_CASE("planes that a body cannot have are refused") {
  PlaneBody of = plane_body(ElementType::quad4, PlaneState::axisymmetric, 0.0);
  of.owned.mesh.coordinates[0] = -0.1;
  CHECK_THROWS_WITH_AS(Operator(of.body()),
                       "coordinates: node 0 of an axisymmetric mesh has a radius below 0",
                       std::invalid_argument);
  of = plane_body(ElementType::quad4, PlaneState::stress, 0.0);
  of.owned.laws[0].mean_dilatation = true;
  CHECK_THROWS_WITH_AS(Operator(of.body()), "laws: mean dilatation (B-bar) is not for plane stress",
                       std::invalid_argument);
  const OwnedBody cube = test::small_body(ElementType::hex8, 1);
  Body body = cube.body();
  body.mesh.plane = PlaneState::stress;
  CHECK_THROWS_WITH_AS(Operator(body, {}), "plane: expected plane strain, as the mesh is not flat",
                       std::invalid_argument);
  of = plane_body(ElementType::tri3, PlaneState::stress, 0.0);
  Operator op(of.body());
  std::vector<double> u(op.unknowns()), x(of.body().secant_count());
  CHECK_THROWS_AS(op.strain(u, x), std::logic_error);
}
