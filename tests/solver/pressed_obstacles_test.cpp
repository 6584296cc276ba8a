// SPDX-License-Identifier: BSD-3-Clause
// Obstacles with closed-form solutions: cone, cylinder from both sides, bore, block.
#include <doctest/doctest.h>

#include <algorithm>

#include "../sanitized.hpp"
#include "half_space.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Sneddon's cone, pressed in until the contact radius is 1: F relative to the exact 2/π E* δ² tan α.
double cone(int n) {
  const HalfSpace space{n};
  const Law law = elastic_law(1.0, 0.3);
  const double tangent = 50.0, depth = M_PI / 2 / tangent,
               force = 2 / M_PI * plane_modulus(law) * depth * depth * tangent;
  Model model = pressed_ball(law, 50.0, depth);
  model.contact[0].obstacle =
      Cone{{0, 0, depth}, {0, 0, -1}, std::atan(tangent) * 180 / M_PI, Vector3{0, 0, -1}};
  const Run run = run_changed(space.quarter(), model,
                              [&](Problem& problem) { prescribe_far_field(space, law, force, problem); });
  REQUIRE(run.result().status == Status::converged);
  return 4 * run.result().contact_force[2] / force;
}

struct Line {
  double force, width, peak;  ///< width and peak relative to Hertz's under that force
};

/// Hertz's line contact with R = 50 from a half-plane that is lowered by `sinks`.
Line line_contact(Mesh mesh, const Obstacle& obstacle, std::size_t up = 1) {
  const Law law = elastic_law(1.0, 0.3);
  const std::size_t dim = mesh.dim();
  const double radius = 50.0, sinks = -0.033, deep = dim == 3 ? 0.5 : 1.0;
  Model model;
  model.materials.push_back({everything(), law});
  Vector3 down{};
  down[up] = sinks;
  for (const char* side : {"left", "right", "top"}) {
    BoundaryEntry entry = moved(named(side), static_cast<int>(dim), down);
    model.boundary.push_back(entry);
  }
  if (dim == 3)
    for (const char* side : {"front", "back"}) model.boundary.push_back(roller(named(side), 1));
  const double edge = HalfSpace::fine, low = dim == 3 ? 1.0 : 0.1;
  model.contact.push_back(
      {box({-edge, dim == 3 ? 0.0 : -low, -low}, {edge, dim == 3 ? deep : 0.02, 0.02}), obstacle, {}});
  if (dim == 2) model.contact[0].on = box({-edge, -0.1, 0}, {edge, 0.02, 0});
  const Run run = run_alone(std::move(mesh), model);
  REQUIRE(run.result().status == Status::converged);
  const double force = run.result().contact_force[up] / deep;
  const double a = 2 * std::sqrt(force * radius / (M_PI * plane_modulus(law))), peak = 2 * force / (M_PI * a);
  double width = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i)
    if (run.solution.pressure[i] > 0.0) width += run.part.contact[i].mass / deep;
  return {force, width / (2 * a), run.result().max_contact_pressure / peak};
}

}  // namespace

TEST_CASE("Sneddon's cone: the force, of second order but for the tip" * doctest::skip(sanitized)) {
  const double coarse = cone(4), fine = cone(8);
  CAPTURE(coarse);
  CAPTURE(fine);
  CHECK(std::abs(fine - 1) < 0.01);
  CHECK(std::abs(fine - 1) < 0.5 * std::abs(coarse - 1));
}

TEST_CASE("a cylinder on a plane from both sides: the rigid cylinder, and the rigid plane, press alike") {
  const int n = 8;
  const Mesh flat = HalfSpace{n, 20.0}.plane();
  const Line disc = line_contact(flat, Sphere{{0, -50, 0}, 50.0, Vector3{0, -1, 0}});
  // Here the elastic body is the round one: its surface is a parabola that flattens with the height.
  Mesh round = flat;
  map_nodes(round, [](const Vector3& x) {
    const double inner = std::min(std::abs(x[0]), 2.0);
    return Vector3{x[0], x[1] + inner * inner / 100.0 * (1 - x[1] / 20.0), 0};
  });
  const Line plane = line_contact(round, Plane{{}, {0, 1, 0}});
  for (const Line& line : {disc, plane}) {
    CAPTURE(line.width);
    CAPTURE(line.peak);
    CHECK(std::abs(line.width - 1) < 0.75 / n);
    CHECK(std::abs(line.peak - 1) < 0.02);
  }
  CHECK(std::abs(plane.force / disc.force - 1) < 0.01);
}

TEST_CASE("a cylinder of the axis y pressed into a slice is the disc in the plane") {
  const int n = 4;
  const HalfSpace space{n, 20.0};
  Mesh slice = make_box({{2.0 * space.cells(), 0.5, 1.0 * space.cells()},
                         {2 * space.cells(), 1, space.cells()},
                         ElementType::hex8});
  map_nodes(slice, [&](const Vector3& x) {
    const double i = x[0] - space.cells();
    return Vector3{std::copysign(space.coordinate(std::abs(i)), i), x[1], space.coordinate(x[2])};
  });
  const Vector3 down{0, 0, -1};
  const Line rod = line_contact(slice, Cylinder{{0, 3, -50}, {0, -2, 0}, 50.0, down}, 2);
  const Line nearest = line_contact(slice, Cylinder{{0, 3, -50}, {0, -2, 0}, 50.0, {}}, 2);
  Mesh quads = make_box({{2.0 * space.cells(), 1.0 * space.cells(), 0},
                         {2 * space.cells(), space.cells(), 1},
                         ElementType::quad4});
  map_nodes(quads, [&](const Vector3& x) {
    const double i = x[0] - space.cells();
    return Vector3{std::copysign(space.coordinate(std::abs(i)), i), space.coordinate(x[1]), 0};
  });
  const Line disc = line_contact(quads, Sphere{{0, -50, 0}, 50.0, Vector3{0, -1, 0}});
  CHECK(rod.force == doctest::Approx(disc.force).epsilon(1e-5));
  CHECK(rod.peak == doctest::Approx(disc.peak).epsilon(1e-5));
  CHECK(nearest.force == doctest::Approx(disc.force).epsilon(1e-3));
}

TEST_CASE("a shaft in a bore that is too narrow: p = 2 (λ + μ) e / R, from a cylinder seen from within") {
  const int n = 8;
  Mesh mesh = make_box({{1, 1, 0.25}, {n, n, 1}, ElementType::hex8});
  map_nodes(mesh, [](const Vector3& x) {  // maps squares to circles
    const double far = std::hypot(x[0], x[1]), grow = far > 0 ? std::max(x[0], x[1]) / far : 0;
    return Vector3{x[0] * grow, x[1] * grow, x[2]};
  });
  const Law law = elastic_law(1.0, 0.3);
  const double narrow = 1e-3, lame = law.bulk - 2 * law.shear / 3;
  Model model;
  model.materials.push_back({everything(), law});
  for (const char* side : {"bottom", "top"}) model.boundary.push_back(roller(named(side), 2));
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named("front"), 1));
  for (const char* side : {"right", "back"})
    model.contact.push_back({named(side), Cylinder{{0, 0, 7}, {0, 0, 1}, 1 - narrow, {}, true}, {}});
  model.probes.push_back({0.5, 0, 0.125});
  const Run run = run_alone(mesh, model);
  REQUIRE(run.result().status == Status::converged);
  CHECK(run.probe()[0] == doctest::Approx(-0.5 * narrow).epsilon(0.02));
  double force = 0.0, area = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    force += run.part.contact[i].mass * run.solution.pressure[i];
    area += run.part.contact[i].mass;
  }
  CHECK(force / area == doctest::Approx(2 * (lame + law.shear) * narrow).epsilon(0.01));
}

TEST_CASE("a block is a flat punch: what a plane under its width alone does") {
  const Law law = elastic_law(1.0, 0.3);
  std::vector<double> force;
  for (const bool block : {false, true}) {
    Model model;
    model.materials.push_back({everything(), law});
    for (const char* side : {"left", "right", "top"})
      model.boundary.push_back(moved(named(side), 2, {0, -0.03, 0}));
    const double width = block ? HalfSpace::fine : 1.0;
    const Obstacle obstacle =
        block ? Obstacle(Block{{-1, -1, 0}, {1, 0, 0}}) : Obstacle(Plane{{}, {0, 1, 0}});
    model.contact.push_back({box({-width, 0, 0}, {width, 0, 0}), obstacle, {}});
    const Run run = run_alone(HalfSpace{8, 20.0}.plane(), model);
    REQUIRE(run.result().status == Status::converged);
    force.push_back(run.result().contact_force[1]);
  }
  CHECK(force[1] == doctest::Approx(force[0]).epsilon(1e-5));
}
