// SPDX-License-Identifier: BSD-3-Clause
// B-bar against volumetric locking in the thick cylinder of MacNeal and Harder (1985): nearly incompressible
// elasticity, and compressible elasticity deep in plastic flow.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <kacanov/operator.hpp>
#include "bodies.hpp"

using namespace kacanov;

namespace {

constexpr double inner_radius = 3.0, outer_radius = 9.0, young = 1000.0;

constexpr int steps = 9;  ///< elements along the quarter arc
constexpr double half_step = std::numbers::pi / (4 * steps);
constexpr double facet = 2.0 * inner_radius;  ///< length of an inner facet, divided by sin(half_step)

/// Solves A u = r on the unconstrained unknowns by conjugate gradients from u = 0, preconditioned by the
/// given diagonal.
template <class Apply>
std::vector<double> solve(Apply&& apply, std::span<const double> diagonal, std::span<const char> held,
                          std::vector<double> r) {
  const std::size_t n = r.size();
  for (std::size_t k = 0; k < n; ++k)
    if (held[k]) r[k] = 0.0;
  std::vector<double> u(n, 0.0), z(n), p(n, 0.0), y(n);
  const double goal = 1e-24 * test::dot(r, r);
  double rz = 0.0;
  for (int i = 0; i < 20000 && test::dot(r, r) > goal; ++i) {
    for (std::size_t k = 0; k < n; ++k) z[k] = r[k] / diagonal[k];
    const double next = test::dot(r, z);
    for (std::size_t k = 0; k < n; ++k) p[k] = z[k] + (rz > 0.0 ? next / rz : 0.0) * p[k];
    rz = next;
    apply(p, y);
    for (std::size_t k = 0; k < n; ++k)
      if (held[k]) y[k] = 0.0;
    const double step = rz / test::dot(p, y);
    for (std::size_t k = 0; k < n; ++k) u[k] += step * p[k], r[k] -= step * y[k];
  }
  CHECK(test::dot(r, r) <= goal);
  return u;
}

/// A quarter of the cylinder in plane strain: five elements through the thickness, ten degrees each, one
/// layer in 3D.
struct Cylinder {
  meshes::OwnedMesh mesh;
  std::size_t dim;
  double layers;           ///< of nodes along the axis
  std::vector<char> held;  ///< constrained by symmetry or plane strain
  std::vector<double>
      load;  ///< nodal forces of a unit inner pressure, a quarter of each facet per node; not valid for tet10
  std::vector<double> inner_normal;  ///< radial unit vector at nodes of the inner surface, 0 elsewhere

  explicit Cylinder(ElementType type)
      : mesh(meshes::box(type, {5, steps, 1}, {5, steps, 1})),
        dim(dimension(type)),
        layers(dim == 3 ? 2.0 : 1.0),
        held(mesh.coordinates.size(), 0),
        load(held.size(), 0.0),
        inner_normal(held.size(), 0.0) {
    constexpr double radius[6] = {inner_radius, 3.5, 4.2, 5.2, 6.75, outer_radius};
    for (std::size_t i = 0; i < held.size(); i += dim) {
      double* x = &mesh.coordinates[i];
      const auto ring = static_cast<std::size_t>(x[0]);  // mid-sides of tet10: on the arc between rings
      const double between = x[0] - static_cast<double>(ring), step = x[1], angle = 2.0 * half_step * step;
      const double r = radius[ring] + (between > 0.0 ? between * (radius[ring + 1] - radius[ring]) : 0.0);
      x[0] = r * std::cos(angle), x[1] = r * std::sin(angle);
      held[i] = step == steps, held[i + 1] = step == 0;
      if (dim == 3) held[i + 2] = 1;
      if (r != inner_radius) continue;
      inner_normal[i] = std::cos(angle), inner_normal[i + 1] = std::sin(angle);
      for (const double side : {-1.0, 1.0}) {
        if ((side < 0 && step == 0) || (side > 0 && step == steps)) continue;
        const double normal = angle + side * half_step, share = 0.5 / layers * facet * std::sin(half_step);
        load[i] += share * std::cos(normal), load[i + 1] += share * std::sin(normal);
      }
    }
  }

  /// Radial displacement of the inner surface under pressure, divided by the exact one of linear elasticity.
  double displacement(double poisson, bool mean_dilatation) const {
    Law law = elastic_law(young, poisson);
    law.mean_dilatation = mean_dilatation;
    const auto owned = test::with_one_law(mesh, law);
    Operator op(owned.body());
    std::vector<double> diagonal(op.unknowns());
    op.diagonal(diagonal);
    const auto u = solve([&](const auto& x, auto& y) { op.apply(x, y); }, diagonal, held, load);
    const double a = inner_radius, b = outer_radius;
    const double exact =
        a * a * (1 + poisson) / (young * (b * b - a * a)) * ((1 - 2 * poisson) * a + b * b / a);
    for (std::size_t i = 0; i < u.size(); i += dim)
      if (inner_normal[i] == 1.0) return u[i] / exact;
    return 0.0;
  }

  /// Inner pressure divided by the exact one of an incompressible body, for an inner surface displaced
  /// outward until its strain is `strain` x0: logarithmic law, nu = 0.3, Newton with a line search that never
  /// lets the energy rise.
  double plastic_pressure(double strain, bool mean_dilatation) const {
    Law law = elastic_law(young, 0.3);
    constexpr double x0 = 1e-6;
    law.form = laws::Logarithmic{x0};
    law.mean_dilatation = mean_dilatation;
    auto owned = test::with_one_law(mesh, law);
    owned.make_patches();
    Operator op(owned.body());
    const std::size_t n = op.unknowns();
    // On the inner surface u = C/r, x = √2 C/r² is prescribed; inside the body it is the initial guess.
    const double c = strain * x0 * inner_radius * inner_radius / std::numbers::sqrt2;
    std::vector<double> u(n, 0.0), f(n), diagonal(n);
    std::vector<char> fixed(held);
    for (std::size_t i = 0; i < n; i += dim) {
      const double x = mesh.coordinates[i], y = mesh.coordinates[i + 1], r2 = x * x + y * y;
      u[i] = held[i] ? 0.0 : c * x / r2, u[i + 1] = held[i + 1] ? 0.0 : c * y / r2;
      if (inner_normal[i] + inner_normal[i + 1] > 0.0) fixed[i] = fixed[i + 1] = 1;
    }
    const auto unbalanced = [&] {
      double square = 0.0;
      for (std::size_t k = 0; k < n; ++k)
        if (!fixed[k]) square += f[k] * f[k];
      return std::sqrt(square / test::dot(f, f));
    };
    double energy = op.residual_energy_update(u, f);
    for (int step = 0; step < 50 && unbalanced() > 1e-8; ++step) {
      op.update_tangent(u);
      op.diagonal(diagonal);
      const auto d = solve([&](const auto& x, auto& y) { op.apply_tangent(x, y); }, diagonal, fixed, f);
      std::vector<double> next(n);
      double next_energy = 0.0, length = 2.0;
      do {
        length *= 0.5;
        for (std::size_t k = 0; k < n; ++k) next[k] = u[k] - length * d[k];
        next_energy = op.residual_energy_update(next, f);
      } while (next_energy > energy * (1.0 + 1e-12) && length > 1e-3);
      u = next, energy = next_energy;
    }
    CHECK(unbalanced() <= 1e-8);
    // The pressure does the same work as the reactions, on the volume swept by the inner surface.
    const bool curved = cell(mesh.type).order == 2;
    const double swept = curved ? 0.5 * std::numbers::pi * inner_radius
                                : steps * facet * std::sin(half_step) * std::cos(half_step);
    const auto h = [&](double x) {  // antiderivative of g
      const double l = std::log(x / x0);
      return law.shear * (l < 0.0 ? x : x0 * (1.0 + l + 0.5 * l * l));
    };
    const double x_a = strain * x0, x_b = x_a * std::pow(inner_radius / outer_radius, 2);
    return test::dot(f, inner_normal) / swept / (std::numbers::sqrt2 * (h(x_a) - h(x_b)));
  }
};

}  // namespace

TEST_CASE("B-bar does not lock where the plain element does") {
  ElementType type = ElementType::hex8;
  SUBCASE("hex8") {}
  SUBCASE("quad4") { type = ElementType::quad4; }
  const Cylinder cylinder(type);
  CHECK(cylinder.displacement(0.3, false) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(cylinder.displacement(0.3, true) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(cylinder.displacement(0.4999, false) < 0.3);
  CHECK(cylinder.displacement(0.4999, true) == doctest::Approx(1.0).epsilon(0.03));
}

TEST_CASE("means round the corners do not lock in plastic flow") {
  ElementType type = ElementType::tet10;
  SUBCASE("tet10") {}
  SUBCASE("tet4") { type = ElementType::tet4; }
  const Cylinder cylinder(type);
  for (const double strain : {10.0, 1e3, 1e4}) {
    const double plain = cylinder.plastic_pressure(strain, false),
                 mixed = cylinder.plastic_pressure(strain, true);
    CAPTURE(plain);
    CAPTURE(mixed);
    // The exact pressure is that of an incompressible body; at ten yield strains the body is still slightly
    // compressible. The cylinder is two nodes thick, so that the patches of tet4 extend through its whole
    // thickness.
    const double coarse = type == ElementType::tet4 ? 0.02 : 0.005;
    CHECK(mixed == doctest::Approx(1.0).epsilon(strain > 100.0 ? coarse : 0.02));
    if (type == ElementType::tet4 && strain > 100.0) CHECK(plain > 2.0);
  }
}

// In plastic flow g falls while k0 stays constant, so every body becomes nearly incompressible.
TEST_CASE("B-bar does not lock in plastic flow either") {
  ElementType type = ElementType::hex8;
  SUBCASE("hex8") {}
  SUBCASE("quad4") { type = ElementType::quad4; }
  const Cylinder cylinder(type);
  CHECK(cylinder.plastic_pressure(10.0, false) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(cylinder.plastic_pressure(10.0, true) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(cylinder.plastic_pressure(1e3, false) > 1.4);
  CHECK(cylinder.plastic_pressure(1e3, true) == doctest::Approx(1.0).epsilon(0.02));
  CHECK(cylinder.plastic_pressure(1e4, false) > 4.0);
  CHECK(cylinder.plastic_pressure(1e4, true) == doctest::Approx(1.0).epsilon(0.02));
}
