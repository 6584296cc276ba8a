// SPDX-License-Identifier: BSD-3-Clause
// Contact of quadratic facets: uniform pressure and shear are exact on an irregular mesh, and Hertz's
// pressure converges.
#include <doctest/doctest.h>

#include <algorithm>

#include "formats/gmsh_reader.hpp"
#include "half_space.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// The irregular cube with side `unit`, rotated.
Mesh uneven_cube(double unit, const Rotation& turn) {
  Mesh mesh = read_gmsh(KACANOV_UNEVEN_CUBE);
  find_boundary(mesh);
  check_mesh(mesh);
  map_nodes(mesh, [&](const Vector3& x) { return turn({unit * x[0], unit * x[1], unit * x[2]}); });
  return mesh;
}

double order(double coarse, double fine, double ratio) {
  return std::log(std::abs(coarse / fine)) / std::log(ratio);
}

/// A ball of radius 50 pressed in by 1/50 with cells of size 1/n: largest pressure and contact radius
/// relative to Hertz's under the computed force.
struct Hertz {
  double peak, radius;
};
Hertz hertz_at(int n) {
  const HalfSpace space{n};
  const Law law = elastic_law(1.0, 0.3);
  const double radius = 50.0, depth = 1.0 / radius, modulus = plane_modulus(law);
  const Model model = pressed_ball(law, radius, depth);
  const Run run = run_alone(space.quarter(ElementType::tet10), model);
  REQUIRE(run.result().status == Status::converged);
  const double force = 4 * run.result().contact_force[2], a = std::cbrt(0.75 * force * radius / modulus);
  return {run.result().max_contact_pressure * M_PI * a * radius / (2 * modulus * a * a), a};
}

}  // namespace

TEST_CASE("tet10: an even pressure is exact to rounding, turned, in m and mm, on any number of ranks") {
  const Rotation turn(3, 0.7);
  for (const double unit : {1.0, 1e-3}) {
    CAPTURE(unit);
    const Vector3 press{0.3e-2, 0.8e-2, 2e-2};
    Model model;
    model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
    const std::array<std::pair<const char*, const char*>, 3> sides{
        {{"left", "right"}, {"front", "back"}, {"bottom", "top"}}};
    for (std::size_t c = 0; c < 3; ++c) {
      Vector3 normal{};
      normal[c] = 1.0;
      model.boundary.push_back(pressure(named(sides[c].second), press[c]));
      model.contact.push_back(on_plane(named(sides[c].first), {}, turn(normal)));
    }
    model.solver.tolerance = 1e-11;
    Part part;
    const Solution solution = solve_everywhere(build_problem(uneven_cube(unit, turn), model), model, part);
    CHECK(solution.result.status == Status::converged);
    for (std::size_t i = 0; i < part.contact.size(); ++i)
      CHECK(solution.pressure[i] ==
            doctest::Approx(press[static_cast<std::size_t>(part.contact[i].entry)]).epsilon(1e-8));
    CHECK(solution.result.max_contact_pressure == doctest::Approx(2e-2).epsilon(1e-8));
  }
}

TEST_CASE("tet10: an even shear under its bound sticks everywhere, and is exact") {
  const Rotation turn(3, 2.1);
  for (const bool coulomb : {false, true})
    for (const Vector3& shear : {Vector3{1e-3, 0, 0}, Vector3{-0.6e-3, 0.7e-3, 0}}) {
      CAPTURE(coulomb);
      CAPTURE(shear[1]);
      // σ = [[0, 0, sx], [0, 0, sy], [sx, sy, −p]], so that every side carries its traction.
      const double push = 1e-2;
      Model model;
      model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
      model.boundary.push_back(traction(named("top"), turn({shear[0], shear[1], -push})));
      model.boundary.push_back(traction(named("right"), turn({0, 0, shear[0]})));
      model.boundary.push_back(traction(named("left"), turn({0, 0, -shear[0]})));
      model.boundary.push_back(traction(named("back"), turn({0, 0, shear[1]})));
      model.boundary.push_back(traction(named("front"), turn({0, 0, -shear[1]})));
      model.materials[0].law = elastic_law(1.0, 0.0);  // ν = 0: no lateral stress
      model.contact.push_back(
          on_plane(named("bottom"), {}, turn({0, 0, 1}), coulomb ? 0.0 : 1.2e-3, coulomb ? 0.12 : 0.0));
      model.solver.tolerance = 1e-11;
      Part part;
      const Solution solution = solve_everywhere(build_problem(uneven_cube(1.0, turn), model), model, part);
      CHECK(solution.result.status == Status::converged);
      CHECK(solution.result.slip_nodes == 0);
      const Vector3 expected = turn({-shear[0], -shear[1], 0});
      for (std::size_t i = 0; i < part.contact.size(); ++i) {
        CHECK(solution.pressure[i] == doctest::Approx(push).epsilon(1e-8));
        CHECK(distance(solution.traction[i], expected) < 1e-8 * push);
      }
    }
}

TEST_CASE("tet10: Hertz's peak within 2 % at ten facets across the contact, and converging") {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) return;
  const Hertz coarse = hertz_at(3), fine = hertz_at(5);
  CAPTURE(coarse.peak);
  CAPTURE(fine.peak);
  CAPTURE(fine.radius);
  CHECK(std::abs(fine.peak - 1) < 0.02);
  CHECK(order(coarse.peak - 1, fine.peak - 1, 5.0 / 3.0) > 1.0);
}
