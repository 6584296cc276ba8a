// SPDX-License-Identifier: BSD-3-Clause
// Contact problems of the half-space with closed-form solutions: Hertz, Cattaneo–Mindlin, flat punch.
#include <doctest/doctest.h>

#include <algorithm>

#include "half_space.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

double order(double coarse, double fine) { return std::log2(std::abs(coarse / fine)); }

/// Results of one mesh.
struct Hertz {
  double force;         ///< relative to the exact one; cylinder: exact half-width under the computed force
  double radius, peak;  ///< relative to the exact ones
  double profile;       ///< relative error of the pressure in L²
};

/// A ball of radius 50 pressed in by δ = a²/R with a = 1.
Hertz ball(int n) {
  const HalfSpace space{n};
  const Law law = elastic_law(1.0, 0.3);
  const double radius = 50.0, depth = 1.0 / radius, modulus = plane_modulus(law);
  const double force = 4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(depth, 1.5),
               peak = 2 * modulus / (M_PI * radius);
  const Model model = pressed_ball(law, radius, depth);
  const Run run = run_changed(space.quarter(), model,
                              [&](Problem& problem) { prescribe_far_field(space, law, force, problem); });
  REQUIRE(run.result().status == Status::converged);
  double area = 0.0, error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    const double* x = node_of(run, i);
    const double mass = run.part.contact[i].mass, r = std::hypot(x[0], x[1]);
    const double exact = r < 1.0 ? peak * std::sqrt(1 - r * r) : 0.0;
    if (run.solution.pressure[i] > 0.0) area += mass;
    error += mass * std::pow(run.solution.pressure[i] - exact, 2);
    size += mass * exact * exact;
  }
  return {4 * run.result().contact_force[2] / force, std::sqrt(4 * area / M_PI),
          run.solution.pressure[0] / peak, std::sqrt(error / size)};
}

/// Half-plane whose outer sides are displaced by `shift`; contact on |x| ≤ width.
Model half_plane(const Law& law, const Vector3& shift, double width, const Obstacle& obstacle,
                 std::optional<Friction> friction = std::nullopt) {
  Model model;
  model.materials.push_back({everything(), law});
  for (const char* side : {"left", "right", "top"}) model.boundary.push_back(moved(named(side), 2, shift));
  model.contact.push_back({box({-width, 0, 0}, {width, 0, 0}), obstacle, friction});
  return model;
}

/// Returns ‖pressure − exact‖ / ‖exact‖ in L² over |x| < width.
double profile_error(const Run& run, double width, const std::function<double(std::size_t)>& found,
                     const std::function<double(double)>& exact) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    const double x = node_of(run, i)[0], mass = run.part.contact[i].mass;
    if (std::abs(x) >= width) continue;
    error += mass * std::pow(found(i) - exact(x), 2);
    size += mass * std::pow(exact(x), 2);
  }
  return std::sqrt(error / size);
}

/// Hertz's half-width and pressure under the computed force, for a cylinder of radius 50.
Hertz cylinder(int n) {
  const Law law = elastic_law(1.0, 0.3);
  const double radius = 50.0, modulus = plane_modulus(law);
  // The approach of a half-plane depends on its extent; this value gives a contact half-width of about a = 1.
  Sphere round;
  round.radius = radius;
  round.centre = {0.0, -radius, 0.0};
  round.direction = Vector3{0.0, -1.0, 0.0};
  const Run run =
      run_alone(HalfSpace{n, 20.0}.plane(), half_plane(law, {0.0, -0.033, 0.0}, HalfSpace::fine, round));
  REQUIRE(run.result().status == Status::converged);
  const double force = run.result().contact_force[1];
  const double a = 2 * std::sqrt(force * radius / (M_PI * modulus)), peak = 2 * force / (M_PI * a);
  REQUIRE(a > 0.7);
  REQUIRE(a < 1.1);
  double width = 0.0, found_peak = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    if (run.solution.pressure[i] > 0.0) width += run.part.contact[i].mass;
    if (std::abs(node_of(run, i)[0]) < 1e-12) found_peak = run.solution.pressure[i];
  }
  const double error = profile_error(
      run, HalfSpace::fine, [&](std::size_t i) { return run.solution.pressure[i]; },
      [&](double x) { return std::abs(x) < a ? peak * std::sqrt(1 - x * x / (a * a)) : 0.0; });
  return {a, width / (2 * a), found_peak / peak, error};
}

/// Rigid flat punch of half-width 1: the pressure under the computed force P, in the middle and over |x| <
/// 0.8, relative to P / (π √(1 − x²)).
struct Punch {
  double middle, profile;
};
Punch punch(int n) {
  const Law law = elastic_law(1.0, 0.3);
  const Run run = run_alone(HalfSpace{n, 20.0}.plane(),
                            half_plane(law, {0.0, -0.03, 0.0}, 1.0, Plane{{}, {0.0, 1.0, 0.0}}));
  REQUIRE(run.result().status == Status::converged);
  const double force = run.result().contact_force[1];
  const auto exact = [&](double x) { return force / (M_PI * std::sqrt(1 - x * x)); };
  const auto found = [&](std::size_t i) { return run.solution.pressure[i]; };
  double middle = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i)
    if (std::abs(node_of(run, i)[0]) < 1e-12) middle = found(i);
  return {middle / exact(0.0), profile_error(run, 0.8, found, exact)};
}

/// Cattaneo–Mindlin, tangential part only: with the friction bound μp₀ √(1 − x²) on |x| < 1, given per node,
/// a force Q leaves |x| < c = √(1 − Q/(μP)) sticking, with tractions μp₀ (√(1 − x²) − c √(1 − x²/c²)) there.
/// This excludes load history and the coupling of normal and tangential directions (ν < ½).
struct Mindlin {
  double ratio;            ///< Q / μP
  double radius, profile;  ///< computed c / c, error of the tractions
};
Mindlin tangential(int n, double shift) {
  const Law law = elastic_law(1.0, 0.3);
  const double bound = 0.01;  // μ p₀
  const Run run =
      run_changed(HalfSpace{n, 20.0}.plane(),
                  half_plane(law, {shift, 0.0, 0.0}, HalfSpace::fine, ConstantGap{1.0}, Friction{bound, 0.0}),
                  [&](Problem& problem) {
                    for (ContactPoint& point : problem.contact) {
                      const double x = problem.mesh.coordinates[2 * static_cast<std::size_t>(point.node)];
                      point.tresca = bound * std::sqrt(std::max(0.0, 1 - x * x));
                    }
                  });
  REQUIRE(run.result().status == Status::converged);
  CHECK(run.result().active_nodes == 0);
  double limit = 0.0, stick = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    limit += run.part.contact[i].mass * run.part.contact[i].tresca;
    if (run.solution.contact_status[i] == ContactStatus::stick) stick += run.part.contact[i].mass;
  }
  const double ratio = std::abs(run.result().friction_force[0]) / limit, c = std::sqrt(1 - ratio);
  const double error = profile_error(
      run, 1.0, [&](std::size_t i) { return std::abs(run.solution.traction[i][0]); },
      [&](double x) {
        const double whole = bound * std::sqrt(1 - x * x);
        return std::abs(x) < c ? whole - bound * c * std::sqrt(1 - x * x / (c * c)) : whole;
      });
  return {ratio, stick / (2 * c), error};
}

/// The whole problem with Coulomb's law: a cylinder pressed and dragged at once. As ν → ½ the directions
/// decouple, and the final slip agrees with Mindlin's increments, so that history does not matter. With ν =
/// 0.45 and μ = 1 the remaining coupling moves the edge of the stick zone by 2 % (with ν = 0.3 by 12 %).
struct Dragged {
  double ratio;            ///< Q / μP
  double stick, expected;  ///< half-widths
};
Dragged dragged(int n, double poisson, double shift) {
  const Law law = elastic_law(1.0, poisson);
  const double radius = 50.0, modulus = plane_modulus(law), coefficient = 1.0;
  Sphere round;
  round.radius = radius;
  round.centre = {0.0, -radius, 0.0};
  round.direction = Vector3{0.0, -1.0, 0.0};
  const Run run = run_alone(HalfSpace{n, 20.0}.plane(), half_plane(law, {shift, -0.033, 0.0}, HalfSpace::fine,
                                                                   round, Friction{0.0, coefficient}));
  REQUIRE(run.result().status == Status::converged);
  const double force = run.result().contact_force[1], drag = std::abs(run.result().friction_force[0]);
  const double a = 2 * std::sqrt(force * radius / (M_PI * modulus));
  double stick = 0.0;
  for (std::size_t i = 0; i < run.part.contact.size(); ++i)
    if (run.solution.contact_status[i] == ContactStatus::stick) stick += run.part.contact[i].mass;
  const double ratio = drag / (coefficient * force);
  return {ratio, stick / 2, a * std::sqrt(1 - ratio)};
}

}  // namespace

TEST_CASE("Hertz, a ball: force and pressure of second order, radius to a cell") {
  const Hertz coarse = ball(4), fine = ball(8);
  CAPTURE(coarse.force);
  CAPTURE(fine.force);
  CHECK(order(coarse.force - 1, fine.force - 1) > 1.7);
  CHECK(std::abs(fine.force - 1) < 0.01);
  CAPTURE(coarse.peak);
  CAPTURE(fine.peak);
  CHECK(order(coarse.peak - 1, fine.peak - 1) > 1.7);
  CHECK(std::abs(fine.peak - 1) < 0.005);
  CAPTURE(coarse.radius);
  CAPTURE(fine.radius);
  CHECK(order(coarse.radius - 1, fine.radius - 1) > 0.8);
  CHECK(std::abs(fine.radius - 1) < 0.75 / 8);
  CHECK(order(coarse.profile, fine.profile) > 0.8);
  CHECK(fine.profile < 0.06);
}

TEST_CASE("Hertz, a cylinder: width to a cell, pressure") {
  const Hertz coarse = cylinder(8), fine = cylinder(16);
  CAPTURE(coarse.peak);
  CAPTURE(fine.peak);
  CHECK(order(coarse.peak - 1, fine.peak - 1) > 1.2);
  CHECK(std::abs(fine.peak - 1) < 0.005);
  CHECK(std::abs(coarse.radius - 1) * coarse.force < 0.75 / 8);
  CHECK(std::abs(fine.radius - 1) * fine.force < 0.75 / 16);
  CHECK(coarse.profile < 0.3 / 8);
  CHECK(fine.profile < 0.5 / 16);
}

TEST_CASE("flat punch: pressure of first order, its singular edges notwithstanding") {
  const Punch coarse = punch(8), fine = punch(16);
  CAPTURE(fine.middle);
  CAPTURE(fine.profile);
  CHECK(order(coarse.middle - 1, fine.middle - 1) > 0.9);
  CHECK(std::abs(fine.middle - 1) < 0.03);
  CHECK(order(coarse.profile, fine.profile) > 0.9);
  CHECK(fine.profile < 0.05);
}

TEST_CASE("Cattaneo and Mindlin, the tangential problem: stick to a cell, tractions of first order") {
  double before = 0.0;
  for (const double shift : {0.005, 0.01, 0.02}) {
    for (const int n : {8, 16}) {
      CAPTURE(n);
      const Mindlin found = tangential(n, shift);
      CAPTURE(found.ratio);
      const double c = std::sqrt(1 - found.ratio);
      CHECK(found.ratio > before);
      CHECK(found.ratio < 0.7);
      CHECK(std::abs(found.radius - 1) * c < 0.75 / n);
      CHECK(found.profile < 4.5 / n);
      if (n == 16) before = found.ratio;
    }
  }
}

TEST_CASE("Cattaneo and Mindlin, Coulomb's law with pressure and drag at once: stick to a cell") {
  for (const int n : {8, 16}) {
    CAPTURE(n);
    const Dragged found = dragged(n, 0.45, 0.018);
    CAPTURE(found.ratio);
    CHECK(found.ratio > 0.4);
    CHECK(found.ratio < 0.6);
    CHECK(std::abs(found.stick - found.expected) < 1.0 / n);
  }
}
