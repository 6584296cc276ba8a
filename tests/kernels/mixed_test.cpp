// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure formulation: matrices computed by hand, the displacement form, the inf-sup
// condition.
#include <kacanov/reference.hpp>

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <stdexcept>

#include "../dense_algebra.hpp"
#include "bodies.hpp"

using namespace kacanov;
using test::difference;
using test::dot;

namespace {

struct Fields {
  std::vector<double> u, p;
};

Fields fields(const Body& body, unsigned seed) {
  return {test::random_vector(body.unknowns(), seed), test::random_vector(body.mesh.node_count(), seed + 1)};
}

Fields product(const Body& body, std::span<const double> g, const Fields& x) {
  Fields y{std::vector<double>(x.u.size(), 7.0), std::vector<double>(x.p.size(), 7.0)};
  reference::apply_mixed(body, g, {x.u, x.p}, {y.u, y.p});
  return y;
}

/// Returns u = H x and p = k0 tr H, with k0 of the first law.
Fields linear(const Body& body, const double (&h)[3][3]) {
  const std::size_t dim = dimension(body.mesh.type);
  Fields x{std::vector<double>(body.unknowns(), 0.0), {}};
  double trace = 0.0;
  for (std::size_t i = 0; i < dim; ++i) trace += h[i][i];
  for (std::size_t i = 0; i < x.u.size(); ++i)
    for (std::size_t k = 0; k < dim; ++k) x.u[i] += h[i % dim][k] * body.mesh.coordinates[i - i % dim + k];
  x.p.assign(body.mesh.node_count(), body.laws[0].bulk * trace);
  return x;
}

constexpr ElementType simplices[] = {ElementType::tri3, ElementType::tet4, ElementType::tet10};

/// Smallest eigenvalues λ of B A⁻¹Bᵀ q = λ (mass / 2g) q, with B and the mass matrix free of the bulk
/// modulus.
struct InfSup {
  double bare, stabilised;  ///< pressures at corners: without and with the stabilisation added to B A⁻¹Bᵀ
  double patches;           ///< pressures on patches
};

/// Computes them for a perturbed cube that is fixed on one side.
InfSup inf_sup(ElementType type, int cells) {
  auto mesh = meshes::box(type, {cells, cells, cells}, {1.0, 1.0, 1.0});
  meshes::jitter(mesh, type == ElementType::tet4 ? 0.15 : 0.05, 3);
  Law law = elastic_law(1.0, 0.3);
  law.bulk = 1e30;
  law.mean_dilatation = true;
  test::OwnedBody owned = test::with_one_law(std::move(mesh), law);
  owned.make_patches();
  const Body body = owned.body();
  const std::vector<double> g(body.secant_count(), law.shear);
  std::vector<char> corner(body.mesh.node_count(), 0);
  const std::size_t nodes = nodes_per_element(type);
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e)
    for (std::size_t c = 0; c < 4; ++c) corner[body.mesh.connectivity[e * nodes + c]] = 1;
  std::vector<std::size_t> free, corners;
  for (std::size_t i = 0; i < body.mesh.node_count(); ++i) {
    if (corner[i]) corners.push_back(i);
    for (std::size_t k = 0; k < 3 && body.mesh.coordinates[3 * i] > 0.3 / cells; ++k)
      free.push_back(3 * i + k);
  }
  Eigen::MatrixXd a(free.size(), free.size()), b(corners.size(), free.size());
  Eigen::MatrixXd s(corners.size(), corners.size());
  Fields x{std::vector<double>(body.unknowns(), 0.0), std::vector<double>(body.mesh.node_count(), 0.0)};
  for (std::size_t j = 0; j < free.size(); ++j) {
    x.u[free[j]] = 1.0;
    const Fields y = product(body, g, x);
    x.u[free[j]] = 0.0;
    for (std::size_t i = 0; i < free.size(); ++i) a(i, j) = y.u[free[i]];
    for (std::size_t i = 0; i < corners.size(); ++i) b(i, j) = y.p[corners[i]];
  }
  for (std::size_t j = 0; j < corners.size(); ++j) {
    x.p[corners[j]] = 1.0;
    const Fields y = product(body, g, x);
    x.p[corners[j]] = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) s(i, j) = -y.p[corners[i]];
  }
  Fields grow = linear(body, {{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
  grow.p.assign(grow.p.size(), 0.0);
  const Fields volume = product(body, g, grow);  // tr ε = 1: the volume lumped to the corners
  Eigen::VectorXd mass(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) mass[i] = volume.p[corners[i]] / (2.0 * law.shear);
  const Eigen::MatrixXd schur = testing::schur_complement(a, b);
  const auto smallest = [](const Eigen::MatrixXd& m, const Eigen::VectorXd& of) {
    const Eigen::VectorXd scale = of.cwiseSqrt().cwiseInverse();
    return testing::symmetric_eigenvalues(scale.asDiagonal() * m * scale.asDiagonal())[0];
  };
  InfSup result{smallest(schur, mass), smallest(schur + s, mass), 0.0};
  if (type != ElementType::tet4) return result;
  std::map<std::int64_t, Eigen::Index> patches;
  for (const std::size_t node : corners)
    patches.emplace(body.pressure_patch[node], static_cast<Eigen::Index>(patches.size()));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(patches.size(), corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) sum(patches.at(body.pressure_patch[corners[i]]), i) = 1.0;
  result.patches = smallest(sum * schur * sum.transpose(), sum * mass);
  return result;
}

}  // namespace

TEST_CASE("the displacement-pressure form of one tetrahedron is that by hand") {
  meshes::OwnedMesh mesh{ElementType::tet4, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 3}};
  Law law = elastic_law(1.0, 0.3);
  law.bulk = 5.0;
  const test::OwnedBody owned = test::with_one_law(std::move(mesh), law);
  const std::vector<double> g{0.25};
  Fields x{std::vector<double>(12, 0.0), {1.0, 0.0, 0.0, 0.0}};
  Fields y = product(owned.body(), g, x);
  const double gradient[12] = {-1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (std::size_t i = 0; i < 12; ++i) CHECK(y.u[i] * 24.0 == doctest::Approx(gradient[i]));  // V/4
  // V = 1/6: V/(4 k0) = 1/120, V/(2g) (1/10 − 1/16) = 1/80, V/(2g) (1/20 − 1/16) = −1/240
  CHECK(y.p[0] == doctest::Approx(-1.0 / 120.0 - 1.0 / 80.0));
  for (std::size_t c = 1; c < 4; ++c) CHECK(y.p[c] == doctest::Approx(1.0 / 240.0));
  x = {std::vector<double>(12, 0.0), std::vector<double>(4, 0.0)};
  x.u[3] = 1.0;  // ε = xx, dev ε = (2, −1, −1)/3, τ = (2, −1, −1)/6
  y = product(owned.body(), g, x);
  const double force[12] = {-2, 1, 1, 2, 0, 0, 0, -1, 0, 0, 0, -1};
  for (std::size_t i = 0; i < 12; ++i) CHECK(y.u[i] * 36.0 == doctest::Approx(force[i]));
  for (const double q : y.p) CHECK(q == doctest::Approx(1.0 / 24.0));
}

TEST_CASE("the displacement-pressure form is symmetric, and blind to rigid motions") {
  for (const ElementType type : simplices) {
    const test::OwnedBody owned = test::small_body(type, 3);
    const Body body = owned.body();
    const std::vector<double> g = test::some_secant(body, 5);
    const Fields x = fields(body, 7), y = fields(body, 11);
    const Fields kx = product(body, g, x), ky = product(body, g, y);
    const double xy = dot(y.u, kx.u) + dot(y.p, kx.p), yx = dot(x.u, ky.u) + dot(x.p, ky.p);
    CHECK(std::abs(xy - yx) < 1e-13 * std::sqrt(dot(kx.u, kx.u) * dot(y.u, y.u)));
    Fields turn = linear(body, {{0.0, -1.0, 0.4}, {1.0, 0.0, -0.3}, {-0.4, 0.3, 0.0}});
    for (double& u : turn.u) u += 0.7;
    const Fields still = product(body, g, turn);
    CHECK(difference(still.u, std::vector<double>(still.u.size(), 0.0)) < 1e-14);
    CHECK(difference(still.p, std::vector<double>(still.p.size(), 0.0)) < 1e-14);
  }
}

TEST_CASE("constant strain with p = k0 tr has the forces of the displacement form and no residual") {
  for (const ElementType type : simplices) {
    auto mesh = meshes::box(type, {3, 2, 2}, {1.5, 1.0, 1.0});
    meshes::jitter(mesh, 0.04, 5);  // curves the edges of tet10
    const test::OwnedBody owned = test::with_one_law(std::move(mesh), elastic_law(1.0, 0.4));
    const Body body = owned.body();
    const std::vector<double> g = test::some_secant(body, 5);
    const Fields x = linear(body, {{0.3, 0.1, -0.2}, {0.4, -0.1, 0.5}, {0.2, 0.1, 0.6}});
    const Fields y = product(body, g, x);
    std::vector<double> plain(x.u.size());
    reference::apply(body, g, x.u, plain);
    CHECK(difference(y.u, plain) < 1e-13);
    CHECK(difference(y.p, std::vector<double>(y.p.size(), 0.0)) < 1e-14);
  }
}

TEST_CASE("the inf-sup constant does not fall with the mesh, and would without the stabilisation") {
  const InfSup coarse = inf_sup(ElementType::tet4, 2), fine = inf_sup(ElementType::tet4, 4);
  CAPTURE(coarse.bare);
  CAPTURE(coarse.stabilised);
  CAPTURE(fine.bare);
  CAPTURE(fine.stabilised);
  CHECK(fine.stabilised > 0.8 * coarse.stabilised);
  CHECK(fine.stabilised > 0.05);
  CHECK(fine.bare < 0.1 * fine.stabilised);
  const double quadratic_coarse = inf_sup(ElementType::tet10, 1).bare,
               quadratic_fine = inf_sup(ElementType::tet10, 2).bare;
  CAPTURE(quadratic_coarse);
  CAPTURE(quadratic_fine);
  CHECK(quadratic_fine > 0.05);
  CHECK(quadratic_fine > 0.5 * quadratic_coarse);
}

TEST_CASE("over patches of nodes pressures have no pattern that displacements do not see") {
  const InfSup coarse = inf_sup(ElementType::tet4, 4), fine = inf_sup(ElementType::tet4, 7);
  CAPTURE(coarse.patches);
  CAPTURE(fine.patches);
  CAPTURE(fine.bare);
  CHECK(coarse.patches > 0.1);
  CHECK(fine.patches > 0.1);  // measured: 0.13 to 0.4 with 6 to 11 cells
  CHECK(fine.bare < 1e-6 * fine.patches);
}

TEST_CASE(
    "volume by corners: the energy of means round the corners, symmetric, and no more than at the points") {
  auto mesh = meshes::box(ElementType::tet10, {3, 2, 2}, {1.0, 0.7, 0.8});
  meshes::jitter(mesh, 0.05, 4);
  auto owned = test::with_every_law(std::move(mesh), 5);
  for (Law& law : owned.laws) law.mean_dilatation = true;
  owned.laws[3].bulk = owned.laws[0].bulk;
  const Body body = owned.body();
  const std::size_t n = body.unknowns(), points = body.secant_count();
  const auto x = test::random_vector(n, 6), z = test::random_vector(n, 7);
  std::vector<double> g = test::random_vector(points, 8), y(n), w(n), at_points(n), strain(6 * points),
                      volume(points);
  for (double& value : g) value = 1.5 + value;
  reference::apply(body, g, x, y);
  reference::apply(body, g, z, w);
  CHECK(dot(x, w) == doctest::Approx(dot(z, y)).epsilon(1e-12));

  Body plain = body;  // dilatation at the quadrature points
  std::vector<Law> plain_laws = owned.laws;
  for (Law& law : plain_laws) law.mean_dilatation = false;
  plain.laws = plain_laws;
  reference::strains(plain, x, strain);
  reference::points(body, {}, volume);
  std::vector<double> change(body.mesh.node_count(), 0.0), mass(change.size(), 0.0);
  const Cell& type = cell(ElementType::tet10);
  double energy = 0.0;
  for (std::size_t k = 0; k < points; ++k) {
    const std::size_t e = k / 4;
    const double* s = &strain[6 * k];
    const double trace = s[0] + s[1] + s[2];
    for (std::size_t i = 0; i < 6; ++i) {
      const double dev = i < 3 ? s[i] - trace / 3.0 : s[i];
      energy += volume[k] * 2.0 * g[k] * (i < 3 ? 1.0 : 2.0) * dev * dev;
    }
    const auto& at = type.points[k % 4];
    const double share[] = {1.0 - at[0] - at[1] - at[2], at[0], at[1], at[2]};
    for (std::size_t c = 0; c < 4; ++c) {
      change[body.mesh.connectivity[10 * e + c]] += volume[k] * share[c] * trace;
      mass[body.mesh.connectivity[10 * e + c]] += volume[k] * share[c] / body.law(e).bulk;
    }
  }
  for (std::size_t c = 0; c < mass.size(); ++c)
    if (mass[c] > 0.0) energy += change[c] * change[c] / mass[c];
  CHECK(dot(x, y) == doctest::Approx(energy).epsilon(1e-12));

  reference::apply(plain, g, x, at_points);
  CHECK(dot(x, y) < 0.9 * dot(x, at_points));
}

TEST_CASE("volume by corners: constant strain has the forces that it has at the points, rigid motions none") {
  auto mesh = meshes::box(ElementType::tet10, {2, 2, 1}, {1.0, 0.7, 0.8});
  meshes::jitter(mesh, 0.05, 4);
  auto owned = test::with_one_law(std::move(mesh), elastic_law(2.0, 0.3));
  const test::OwnedBody plain = owned;
  owned.laws[0].mean_dilatation = true;
  const Body body = owned.body();
  const std::vector<double> g(body.secant_count(), 0.01);
  std::vector<double> expected(body.unknowns()), y(expected.size());
  const Fields x = linear(body, {{0.02, 0.01, -0.03}, {0.02, -0.01, 0.005}, {0.0, 0.01, 0.04}});
  reference::apply(plain.body(), g, x.u, expected);
  reference::apply(body, g, x.u, y);
  CHECK(difference(y, expected) < 1e-12);
  reference::apply(body, g, linear(body, {{0.0, 0.01, -0.03}, {-0.01, 0.0, 0.005}, {0.03, -0.005, 0.0}}).u,
                   y);
  for (const double force : y) CHECK(std::abs(force) < 1e-14);
}

TEST_CASE("the displacement-pressure form of hexahedra is refused") {
  const test::OwnedBody owned = test::small_body(ElementType::hex8, 3);
  const Body body = owned.body();
  CHECK_THROWS_WITH_AS(product(body, test::some_secant(body, 5), fields(body, 7)),
                       doctest::Contains("not of hex8"), std::invalid_argument);
}
