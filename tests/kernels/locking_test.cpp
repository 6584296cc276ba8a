// SPDX-License-Identifier: BSD-3-Clause
// B-bar against volumetric locking: the thick cylinder of MacNeal and Harder (1985), nearly incompressible.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "operator.hpp"

using namespace kacanov;

namespace {

constexpr double inner_radius = 3.0, outer_radius = 9.0, young = 1000.0;

/// A quarter of the cylinder, five elements thick, ten degrees each, one layer in plane strain.
struct Cylinder {
  meshes::OwnedMesh mesh = meshes::box(ElementType::hex8, {5, 9, 1}, {5, 9, 1});
  std::vector<double> load;
  std::vector<char> held;

  Cylinder() : load(mesh.coordinates.size(), 0.0), held(load.size(), 0) {
    constexpr double radius[6] = {inner_radius, 3.5, 4.2, 5.2, 6.75, outer_radius};
    const double facet = 2.0 * inner_radius * std::sin(std::numbers::pi / 36.0);
    for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
      double* x = &mesh.coordinates[i];
      const long ring = std::lround(x[0]), step = std::lround(x[1]);
      const double angle = static_cast<double>(step) * std::numbers::pi / 18.0;
      x[0] = radius[ring] * std::cos(angle), x[1] = radius[ring] * std::sin(angle);
      held[i] = step == 9, held[i + 1] = step == 0, held[i + 2] = 1;
      if (ring != 0) continue;  // unit pressure on the facets at this node, a quarter of each
      for (const double side : {-1.0, 1.0}) {
        if ((side < 0 && step == 0) || (side > 0 && step == 9)) continue;
        const double normal = angle + side * std::numbers::pi / 36.0;
        load[i] += 0.25 * facet * std::cos(normal), load[i + 1] += 0.25 * facet * std::sin(normal);
      }
    }
    for (std::size_t i = 0; i < load.size(); ++i)
      if (held[i]) load[i] = 0.0;
  }

  /// Radial displacement of the inner surface over the exact one.
  double answer(double poisson, bool mean_dilatation) const {
    Law law = elastic_law(young, poisson);
    law.mean_dilatation = mean_dilatation;
    const auto owned = test::with_one_law(mesh, law);
    const Operator op(owned.body());
    const std::size_t n = op.unknowns();
    std::vector<double> u(n, 0.0), r = load, z(n), p(n, 0.0), y(n), d(n);
    op.diagonal(d);
    double rz = 0.0;
    for (int i = 0; i < 5000 && test::dot(r, r) > 1e-24; ++i) {
      for (std::size_t k = 0; k < n; ++k) z[k] = r[k] / d[k];
      const double next = test::dot(r, z);
      for (std::size_t k = 0; k < n; ++k) p[k] = z[k] + (rz > 0.0 ? next / rz : 0.0) * p[k];
      rz = next;
      op.apply(p, y);
      for (std::size_t k = 0; k < n; ++k)
        if (held[k]) y[k] = 0.0;
      const double step = rz / test::dot(p, y);
      for (std::size_t k = 0; k < n; ++k) u[k] += step * p[k], r[k] -= step * y[k];
    }
    CHECK(test::dot(r, r) <= 1e-24);
    const double a = inner_radius, b = outer_radius;
    const double exact =
        a * a * (1 + poisson) / (young * (b * b - a * a)) * ((1 - 2 * poisson) * a + b * b / a);
    for (std::size_t i = 0; i < n; i += 3)
      if (std::abs(mesh.coordinates[i] - a) < 1e-12 && std::abs(mesh.coordinates[i + 1]) < 1e-12)
        return u[i] / exact;
    return 0.0;
  }
};

}  // namespace

TEST_CASE("B-bar does not lock where the plain hexahedron does") {
  const Cylinder cylinder;
  CHECK(cylinder.answer(0.3, false) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(cylinder.answer(0.3, true) == doctest::Approx(1.0).epsilon(0.03));
  CHECK(cylinder.answer(0.4999, false) < 0.3);
  CHECK(cylinder.answer(0.4999, true) == doctest::Approx(1.0).epsilon(0.03));
}
