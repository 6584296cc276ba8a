// SPDX-License-Identifier: BSD-3-Clause
// The reference operator, checked against mechanics: symmetry, rigid motions, derivatives, exact stresses.
#include <kacanov/reference.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "bodies.hpp"
#include "cells/elements.hpp"
#include "reference/matrix.hpp"

using namespace kacanov;
using test::difference;

namespace {

std::size_t dim_of(const test::OwnedBody& body) {
  return static_cast<std::size_t>(dimension(body.mesh.type));
}

std::vector<double> linear_field(const test::OwnedBody& body, const double (&h)[3][3]) {
  const std::size_t dim = dim_of(body);
  std::vector<double> u(body.mesh.coordinates.size(), 0.0);
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t k = 0; k < dim; ++k) u[i] += h[i % dim][k] * body.mesh.coordinates[i - i % dim + k];
  return u;
}

}  // namespace

TEST_CASE("element matrices in closed form are those of the reference") {
  for (const ElementType type : test::all_types) {
    auto mesh = meshes::box(type, {2, 2, 2}, {1.0, 0.7, 1.3});
    meshes::jitter(mesh, 0.04, 3);
    const test::OwnedBody owned = test::with_every_law(std::move(mesh), 5);
    const Body body = owned.body();
    const std::size_t points = points_per_element(type);
    const std::size_t width = nodes_per_element(type) * dimension(type);
    const std::vector<double> g = test::some_secant(body, 11);
    std::vector<double> plain(width * width), closed(width * width, 7.0);
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const auto own = std::span(g).subspan(e * points, points);
      reference::element_matrix(body, e, own, plain);
      element_stiffness(body, e, own, closed);
      CHECK(difference(closed, plain) < 1e-13);
    }
  }
}

TEST_CASE("shape functions are one at their node, sum to one, and their gradients to zero") {
  for (const ElementType type : test::all_types)
    elements::dispatch(type, []<class E>(E) {
      for (const auto& point : E::point) {
        const auto n = E::values(point.data());
        CHECK(std::accumulate(n.begin(), n.end(), 0.0) == doctest::Approx(1.0));
        const auto d = E::gradients(point.data());
        for (std::size_t k = 0; k < E::dim; ++k) {
          double sum = 0.0;
          for (std::size_t a = 0; a < E::nodes; ++a) sum += d[a * E::dim + k];
          CHECK(sum == doctest::Approx(0.0));
          auto forward = point, back = point;
          forward[k] += 1e-6, back[k] -= 1e-6;
          for (std::size_t a = 0; a < E::nodes; ++a)
            CHECK(d[a * E::dim + k] ==
                  doctest::Approx((E::values(forward.data())[a] - E::values(back.data())[a]) / 2e-6));
        }
      }
    });
}

TEST_CASE("the unit tetrahedron by hand") {
  meshes::OwnedMesh mesh{ElementType::tet4, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 3}};
  const auto owned = test::with_one_law(mesh, elastic_law(1.0, 0.25));  // k0 = 2/3, mu = 0.4
  const Body body = owned.body();
  std::vector<double> volume(1);
  reference::volumes(body, volume);
  CHECK(volume[0] == doctest::Approx(1.0 / 6.0));
  // Node 1 moves by 1 along x: eps = xx, tau = diag(k0 + 4/3 mu, k0 − 2/3 mu, k0 − 2/3 mu) = diag(1.2, 0.4,
  // 0.4).
  std::vector<double> u(12, 0.0), f(12), g(1, 0.4);
  u[3] = 1.0;
  reference::apply(body, g, u, f);
  const double expected[] = {-1.2, -0.4, -0.4, 1.2, 0, 0, 0, 0.4, 0, 0, 0, 0.4};
  for (std::size_t i = 0; i < 12; ++i) CHECK(6.0 * f[i] == doctest::Approx(expected[i]));
  CHECK(reference::energy(body, u) == doctest::Approx(0.5 * 1.2 / 6.0));
}

TEST_CASE("plane strain has a zz stress") {
  meshes::OwnedMesh mesh{ElementType::tri3, {0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  const auto owned = test::with_one_law(mesh, elastic_law(1.0, 0.25));
  std::vector<double> u{0, 0, 1, 0, 0, 0}, stress(6), von_mises(1), dev(1), g(1);
  std::vector<std::uint8_t> plastic(1);
  reference::fields(owned.body(), u, {stress, von_mises, dev, g, plastic});
  CHECK(stress[0] == doctest::Approx(1.2));
  CHECK(stress[1] == doctest::Approx(0.4));
  CHECK(stress[2] == doctest::Approx(0.4));
  CHECK(von_mises[0] == doctest::Approx(0.8));
  CHECK(dev[0] == doctest::Approx(std::sqrt(2.0 / 3.0)));
  CHECK(g[0] == doctest::Approx(0.4));
  CHECK(plastic[0] == 0);
}

TEST_CASE("B is symmetric, positive and blind to rigid motions") {
  for (const ElementType type : test::all_types) {
    CAPTURE(static_cast<int>(type));
    const auto owned = test::small_body(type, 1);
    const Body body = owned.body();
    const auto g = test::some_secant(body, 2);
    const auto a = test::random_vector(body.unknowns(), 3), b = test::random_vector(body.unknowns(), 4);
    std::vector<double> ba(a.size()), bb(a.size());
    reference::apply(body, g, a, ba);
    reference::apply(body, g, b, bb);
    CHECK(test::dot(ba, b) == doctest::Approx(test::dot(bb, a)));
    CHECK(test::dot(ba, a) > 0.0);
    auto rigid = linear_field(owned, {{0, 0.3, -0.2}, {-0.3, 0, 0.5}, {0.2, -0.5, 0}});
    for (std::size_t i = 0; i < rigid.size(); ++i) rigid[i] += 0.1 * static_cast<double>(i % dim_of(owned));
    reference::apply(body, g, rigid, bb);
    for (const double force : bb) CHECK(std::abs(force) < 1e-14);
  }
}

TEST_CASE("patch test: a linear field is in equilibrium inside a perturbed mesh") {
  for (const ElementType type : test::all_types) {
    CAPTURE(static_cast<int>(type));
    auto mesh = meshes::box(type, {4, 4, 4}, {1, 1, 1});
    const auto original = mesh.coordinates;
    meshes::jitter(mesh, 0.15, 5);
    meshes::straighten(mesh);  // the quadrature rule is not exact on curved elements
    const auto owned = test::with_one_law(std::move(mesh), test::every_law()[1]);
    const Body body = owned.body();
    const auto u = linear_field(owned, {{0.02, 0.01, 0}, {0.003, -0.01, 0.02}, {0.01, 0, 0.005}});
    std::vector<double> f(u.size());
    reference::residual(body, u, f);
    double largest = 0.0;
    for (const double force : f) largest = std::max(largest, std::abs(force));
    const std::size_t dim = dim_of(owned);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < f.size() / dim; ++i) {
      bool interior = true;
      for (std::size_t k = 0; k < dim; ++k)
        interior = interior && original[i * dim + k] > 1e-9 && original[i * dim + k] < 1 - 1e-9;
      if (!interior) continue;
      ++inside;
      for (std::size_t k = 0; k < dim; ++k) CHECK(std::abs(f[i * dim + k]) < 1e-13 * largest);
    }
    CHECK(inside >= 9);
  }
}

TEST_CASE("residual is the gradient of the energy, the tangent that of the residual") {
  for (const ElementType type : test::all_types) {
    CAPTURE(static_cast<int>(type));
    const auto owned = test::small_body(type, 6);
    const Body body = owned.body();
    const auto u = test::random_vector(body.unknowns(), 7, 0.008);
    const auto v = test::random_vector(body.unknowns(), 8);
    const double h = 1e-7;
    auto plus = u, minus = u;
    for (std::size_t i = 0; i < u.size(); ++i) plus[i] += h * v[i], minus[i] -= h * v[i];
    std::vector<double> f(u.size()), up(u.size()), down(u.size()), tangent(u.size());
    reference::residual(body, u, f);
    const double slope = (reference::energy(body, plus) - reference::energy(body, minus)) / (2 * h);
    CHECK(test::dot(f, v) == doctest::Approx(slope).epsilon(1e-6));
    reference::residual(body, plus, up);
    reference::residual(body, minus, down);
    for (std::size_t i = 0; i < u.size(); ++i) up[i] = (up[i] - down[i]) / (2 * h);
    reference::apply_tangent(body, u, v, tangent);
    CHECK(difference(up, tangent) < 1e-4);  // the laws have kinks: a point on one costs a few digits
  }
}

TEST_CASE("B with g frozen at u gives the residual at u, and fields report that g") {
  for (const ElementType type : test::all_types) {
    CAPTURE(static_cast<int>(type));
    auto mesh = meshes::box(type, {5, 4, 2}, {2.5, 2.0, 1.0});
    meshes::jitter(mesh, 0.04, 9);
    const auto owned = test::with_every_law(std::move(mesh), 9);
    const Body body = owned.body();
    const auto u = test::random_vector(body.unknowns(), 10, 0.01);
    std::vector<double> g(body.secant_count()), f(u.size()), y(u.size());
    reference::secant(body, u, g);
    reference::residual(body, u, f);
    reference::apply(body, g, u, y);
    CHECK(difference(y, f) < 1e-14);
    std::vector<std::uint8_t> plastic(body.mesh.element_count());
    reference::fields(body, u, {{}, {}, {}, {}, plastic});
    const auto count = std::count(plastic.begin(), plastic.end(), 1);
    CHECK(count > 0);
    CHECK(count < static_cast<std::ptrdiff_t>(plastic.size()));
  }
}

TEST_CASE("element matrices sum to the operator, and the diagonals are theirs") {
  for (const ElementType type : test::all_types) {
    CAPTURE(static_cast<int>(type));
    auto owned = test::small_body(type, 11);
    // An element matrix cannot include averages over corners, which couple neighbouring elements.
    for (Law& law : owned.laws) law.mean_dilatation &= !cell(type).corner_dilatation;
    const Body body = owned.body();
    const auto g = test::some_secant(body, 12);
    const auto u = test::random_vector(body.unknowns(), 13, 0.01),
               x = test::random_vector(body.unknowns(), 14);
    const std::size_t dim = dim_of(owned), nodes = static_cast<std::size_t>(nodes_per_element(type));
    const std::size_t n = nodes * dim, points = g.size() / body.mesh.element_count();
    std::vector<double> matrix(n * n), tangent(n * n), y(x.size()), yt(x.size()), diagonal(x.size()),
        blocks(x.size() * dim), tangent_blocks(blocks.size());
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      reference::element_matrix(body, e, std::span(g).subspan(e * points, points), matrix);
      reference::element_tangent(body, e, u, tangent);
      const auto unknown = [&](std::size_t local) {
        return static_cast<std::size_t>(body.mesh.connectivity[e * nodes + local / dim]) * dim + local % dim;
      };
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t c = 0; c < n; ++c) {
          CHECK(matrix[r * n + c] == doctest::Approx(matrix[c * n + r]).epsilon(1e-12));
          y[unknown(r)] += matrix[r * n + c] * x[unknown(c)];
          yt[unknown(r)] += tangent[r * n + c] * x[unknown(c)];
          if (r / dim == c / dim) {
            blocks[unknown(r) * dim + c % dim] += matrix[r * n + c];
            tangent_blocks[unknown(r) * dim + c % dim] += tangent[r * n + c];
          }
          if (r == c) diagonal[unknown(r)] += matrix[r * n + c];
        }
    }
    std::vector<double> actual(x.size()), actual_blocks(blocks.size());
    reference::apply(body, g, x, actual);
    CHECK(difference(actual, y) < 1e-13);
    reference::apply_tangent(body, u, x, actual);
    CHECK(difference(actual, yt) < 1e-13);
    reference::diagonal(body, g, actual);
    CHECK(difference(actual, diagonal) < 1e-13);
    reference::block_diagonal(body, g, actual_blocks);
    CHECK(difference(actual_blocks, blocks) < 1e-13);
    reference::block_diagonal_tangent(body, u, actual_blocks);
    CHECK(difference(actual_blocks, tangent_blocks) < 1e-13);
  }
}

TEST_CASE("volumes fill the box and show inverted elements") {
  for (const ElementType type : test::all_types) {
    auto mesh = meshes::box(type, {3, 2, 2}, {1.5, 1.0, 2.0});
    const auto owned = test::with_one_law(mesh, elastic_law(1, 0.3));
    std::vector<double> volume(owned.body().mesh.element_count());
    reference::volumes(owned.body(), volume);
    const double total = std::accumulate(volume.begin(), volume.end(), 0.0);
    CHECK(total == doctest::Approx(dimension(type) == 2 ? 1.5 : 3.0));
  }
  meshes::OwnedMesh mesh{ElementType::tri3, {0, 0, 1, 0, 0, 1}, {0, 2, 1}};
  const auto owned = test::with_one_law(mesh, elastic_law(1, 0.3));
  std::vector<double> volume(1);
  reference::volumes(owned.body(), volume);
  CHECK(volume[0] == doctest::Approx(-0.5));
}

TEST_CASE("energy and internal force on one walk are those of two") {
  for (const ElementType type :
       {ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(cell(type).name);
    const auto owned = test::small_body(type, 7);
    const Body body = owned.body();
    const std::vector<double> u = test::random_vector(body.unknowns(), 8);
    std::vector<double> both(u.size()), force(u.size());
    const double energy = reference::response(body, u, both);
    reference::residual(body, u, force);
    CHECK(energy == reference::energy(body, u));
    CHECK(both == force);
  }
}
