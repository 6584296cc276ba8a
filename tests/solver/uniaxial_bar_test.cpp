// SPDX-License-Identifier: BSD-3-Clause
// Bars of materials given by tension tests, against Hencky's equations in stresses, which are independent of
// the laws in strains.
#include <doctest/doctest.h>

#include <array>

#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

constexpr double young = 210e3, poisson = 0.3, yield = 250.0;

/// Equivalent plastic strain as a function of the equivalent stress.
using Curve = double (*)(double stress);

double rows_curve(double stress) {
  if (stress <= 250.0) return 0.0;
  return stress <= 320.0 ? 0.02 * (stress - 250.0) / 70.0 : 0.02 + 0.06 * (stress - 320.0) / 60.0;
}
double bilinear_curve(double stress) {
  return stress <= yield ? 0.0 : (stress - yield) * (1.0 / 4e3 - 1.0 / young);
}
double power_curve(double stress) { return 0.4 * 300.0 / young * std::pow(stress / 300.0, 8.0); }

struct Material {
  const char* name;
  Law law;
  Curve curve;
};

std::array<Material, 3> materials() {
  constexpr std::array<std::array<double, 2>, 3> rows{{{250, 0}, {320, 0.02}, {380, 0.08}}};
  const Law elastic = elastic_law(young, poisson);
  std::array<Material, 3> all{{{"rows", elastic, rows_curve},
                               {"tangent modulus", elastic, bilinear_curve},
                               {"Ramberg–Osgood", elastic, power_curve}}};
  all[0].law.form = plastic_table(elastic, rows);
  all[1].law.form = bilinear(elastic, yield, 4e3);
  all[2].law.form = ramberg_osgood(elastic, 300.0, 0.4, 8.0);
  return all;
}

/// ε_i = (σ_i − ν Σ σ_j)/E + 3/2 ε_p/σ_e dev σ_i for principal stresses.
Vector3 strain(const Vector3& stress, Curve curve) {
  const double mean = (stress[0] + stress[1] + stress[2]) / 3.0;
  double square = 0.0;
  for (const double s : stress) square += 1.5 * (s - mean) * (s - mean);
  const double equivalent = std::sqrt(square);
  const double plastic = equivalent > 0.0 ? 1.5 * curve(equivalent) / equivalent : 0.0;
  Vector3 out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = ((1.0 + poisson) * stress[i] - 3.0 * poisson * mean) / young + plastic * (stress[i] - mean);
  return out;
}

/// Returns the σ_z that keeps ε_z = 0 under σ_x and σ_y.
double plane_strain_stress(double x, double y, Curve curve) {
  double low = -1e4, high = 1e4;
  for (int i = 0; i < 200; ++i) {
    const double z = 0.5 * (low + high);
    (strain({x, y, z}, curve)[2] < 0.0 ? low : high) = z;
  }
  return low;
}

/// Returns the displacement of the corner that is free in all directions, of a block 2 × 1 (× 0.5) on
/// rollers.
Vector3 corner_under(ElementType type, const Law& law, const Vector3& stress) {
  const int dim = dimension(type);
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named(dim == 3 ? "front" : "bottom"), 1));
  if (dim == 3) model.boundary.push_back(roller(named("bottom"), 2));
  model.boundary.push_back(traction(named("right"), {stress[0], 0, 0}));
  if (stress[1] != 0.0)
    model.boundary.push_back(traction(named(dim == 3 ? "back" : "top"), {0, stress[1], 0}));
  model.probes.push_back({2.0, 1.0, dim == 3 ? 0.5 : 0.0});
  model.solver.tolerance = 1e-9;
  const Run run = run_alone(box_mesh(type, {2.0, 1.0, 0.5}, 1), model);
  REQUIRE(run.result().status == Status::converged);
  return run.probe();
}

}  // namespace

TEST_CASE("bars in tension follow the curve they were given") {
  for (const Material& material : materials()) {
    CAPTURE(material.name);
    for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
      CAPTURE(static_cast<int>(type));
      for (const double stress : {100.0, 300.0, 370.0}) {
        const Vector3 wanted = strain({stress, 0, 0}, material.curve);
        const Vector3 u = corner_under(type, material.law, {stress, 0, 0});
        CHECK(wanted[0] == doctest::Approx(stress / young + material.curve(stress)).epsilon(1e-13));
        CHECK(u[0] == doctest::Approx(2.0 * wanted[0]).epsilon(1e-6));
        CHECK(u[1] == doctest::Approx(wanted[1]).epsilon(1e-6));
      }
    }
  }
}

TEST_CASE("blocks pulled one way and pressed another follow Hencky's equations") {
  for (const Material& material : materials()) {
    CAPTURE(material.name);
    for (const Vector3& stress : {Vector3{200, -150, 0}, Vector3{330, 150, 0}}) {
      const Vector3 wanted = strain(stress, material.curve),
                    u = corner_under(ElementType::hex8, material.law, stress);
      CHECK(u[0] == doctest::Approx(2.0 * wanted[0]).epsilon(1e-6));
      CHECK(u[1] == doctest::Approx(wanted[1]).epsilon(1e-6));
      CHECK(u[2] == doctest::Approx(0.5 * wanted[2]).epsilon(1e-6));
    }
  }
}

TEST_CASE("bars in plane strain do, with the stress across them") {
  for (const Material& material : materials()) {
    CAPTURE(material.name);
    for (const ElementType type : {ElementType::tri3, ElementType::quad4}) {
      for (const double stress : {100.0, 320.0, 400.0}) {
        const double across = plane_strain_stress(stress, 0.0, material.curve);
        const Vector3 wanted = strain({stress, 0.0, across}, material.curve);
        const Vector3 u = corner_under(type, material.law, {stress, 0, 0});
        CHECK(u[0] == doctest::Approx(2.0 * wanted[0]).epsilon(1e-6));
        CHECK(u[1] == doctest::Approx(wanted[1]).epsilon(1e-6));
      }
    }
  }
}
