// SPDX-License-Identifier: BSD-3-Clause
// Points equally near to an obstacle in several directions: ridges, grooves, edges and corners.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <kacanov/obstacle.hpp>
#include <kacanov/surface.hpp>
#include "problem/vector3.hpp"

using namespace kacanov;

namespace {

/// Two equally steep slopes that meet along y at z = 0: a ridge that points down, or a groove open below.
Surface ridge(double slope, bool groove = false) {
  const double side = groove ? -1.0 : 1.0;
  const std::vector<Vector3> points{
      {0, -2, 0},          {0, 2, 0}, {-1, -2, side * slope}, {-1, 2, side * slope}, {1, -2, side * slope},
      {1, 2, side * slope}};
  return Surface(points, {{0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4}});
}

/// Rotates a vector about an oblique axis.
Vector3 turned(const Vector3& v) {
  constexpr double c = 0.6, s = 0.8;
  const Vector3 once{c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
  return {once[0], c * once[1] - s * once[2], s * once[1] + c * once[2]};
}

Facing look_from(const Obstacle& obstacle, const Vector3& x, const Vector3& outer) {
  return std::visit([&](const auto& kind) { return kind.project({x, outer}); }, obstacle);
}

}  // namespace

TEST_CASE(
    "equally near to both slopes of a ridge contact is along their mean, and the way is that to the ridge") {
  for (const double slope : {0.05, 0.3, 1.0, 4.0})
    for (const bool groove : {false, true}) {
      CAPTURE(slope);
      CAPTURE(groove);
      const SurfaceObstacle blade{std::make_shared<const Surface>(ridge(slope, groove))};
      // Inside the ridge or below the groove, where both nearest points lie on the slopes.
      const double height = groove ? -0.1 : 0.1;
      for (const double y : {-0.3, 0.0, 0.21}) {
        const Facing found = blade.project({{0, y, height}, {0, 0, 1}});
        CHECK(found.chosen);
        CHECK(norm(found.normal - Vector3{0, 0, 1}) < 1e-12);
        CHECK(found.gap == doctest::Approx(-height).epsilon(1e-12));
        // A body tilted to one side faces the slope on that side.
        for (const double to : {-1.0, 1.0}) {
          const Facing one = blade.project({{0, y, height}, {0.3 * to, 0, 1}});
          CHECK(one.normal[0] * to > 0.0);
          CHECK(std::abs(one.gap) == doctest::Approx(0.1 / std::hypot(1.0, slope)).epsilon(1e-12));
        }
      }
      // On the ridge itself, by the planes of both slopes.
      const Facing at_ridge = blade.project({{0, 0.1, 0}, {0, 0, 1}});
      CHECK(norm(at_ridge.normal - Vector3{0, 0, 1}) < 1e-12);
      CHECK(std::abs(at_ridge.gap) < 1e-14);
      CHECK(blade.project({{0, 0.1, 0}, {0.2, 0, 1}}).normal[0] > 0.0);
      // Elsewhere one slope is nearer, and no rule applies.
      CHECK_FALSE(blade.project({{0.01, 0.1, height}, {0, 0, 1}}).chosen);
    }
}

TEST_CASE("at edges and corners of a box the face that opposes the body most is taken, else their mean") {
  const std::array<Vector3, 3> frame{turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
  for (const bool is_turned : {false, true}) {
    const auto place = [&](const Vector3& v) { return is_turned ? turned(v) : v; };
    Block block{place({-1, -1, -1}), place({1, 1, 1})};
    if (is_turned) block.frame = frame;
    const auto look = [&](const Vector3& x, const Vector3& outer) {
      Facing found = look_from(block, place(x), place(outer));
      Vector3 nu{};  // in the axes of the box
      for (std::size_t c = 0; c < 3; ++c) {
        Vector3 axis{};
        axis[c] = 1.0;
        nu[c] = dot(found.normal, place(axis));
      }
      found.normal = nu;
      return found;
    };
    const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 3.0);
    // On the edge x = z = 1, and inside it at equal distance from both faces.
    for (const double depth : {0.0, 0.25, 1e-12}) {
      CAPTURE(depth);
      const Vector3 edge{1 - depth, 0.2, 1 - depth}, corner{1 - depth, 1 - depth, 1 - depth};
      CHECK(norm(look(edge, {0, 0, -1}).normal - Vector3{0, 0, -1}) < 1e-9);
      CHECK_FALSE(look(edge, {0, 0, -1}).chosen);
      CHECK(look(edge, {0, 0, -1}).gap == doctest::Approx(-depth));
      CHECK(norm(look(edge, {-1, 0, -0.9}).normal - Vector3{-1, 0, 0}) < 1e-9);
      CHECK(look(edge, {-1, 0, -0.9}).chosen);
      CHECK(norm(look(edge, {-1, 0, -1}).normal - Vector3{-half, 0, -half}) < 1e-9);
      CHECK(look(edge, {-1, 0, -1}).gap == doctest::Approx(-depth / half));
      CHECK(norm(look(corner, {-1, -1, -1}).normal - Vector3{-third, -third, -third}) < 1e-9);
      CHECK(look(corner, {-1, -1, -1}).gap == doctest::Approx(-depth / third));
      CHECK(norm(look(corner, {-1, -1, 0}).normal - Vector3{-half, -half, 0}) < 1e-9);
    }
    // A node beside the edge by rounding error alone must not face the side of the box.
    for (const double off : {5e-17, 1e-15, -1e-15, 3e-11})
      CHECK(norm(look({1 + off, 0.2, 1}, {0, 0, -1}).normal - Vector3{0, 0, -1}) < 1e-9);
    // Between opposite faces, neither of which opposes the body: always the same one of them.
    const Facing between = look({0, 0, 0}, {0, 0, 0});
    CHECK(norm(between.normal) == doctest::Approx(1.0));
    CHECK(between.gap == doctest::Approx(-1.0));
    CHECK(between.chosen);
  }
}

TEST_CASE("a box of triangles is faced as a box is, at faces, edges and corners, on it and within") {
  std::vector<Vector3> points;
  for (int k = 0; k < 8; ++k) points.push_back({k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0});
  std::vector<Surface::Triangle> triangles;
  for (const std::array<int, 4> side :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    triangles.push_back({side[0], side[1], side[2]});
    triangles.push_back({side[0], side[2], side[3]});
  }
  const SurfaceObstacle faceted{std::make_shared<const Surface>(Surface(points, triangles))};
  const Block block{{-1, -1, -1}, {1, 1, 1}};
  const std::vector<Vector3> places{{1, 0.3, 1},     {1, 1, 1},     {0.7, 0.2, 0.7}, {0.6, 0.6, 0.6},
                                    {0.2, 0.3, 0.9}, {0.4, 0.1, 1}, {0.5, 0.2, 1.5}, {1.5, 0.2, 1.5}};
  for (const Vector3& x : places)
    for (const Vector3& outer : {Vector3{0, 0, -1}, Vector3{-1, 0, -1}, Vector3{-1, 0, -0.9},
                                 Vector3{-1, -1, -1}, Vector3{-1, -2, 0}}) {
      CAPTURE(x[0]);
      CAPTURE(x[2]);
      CAPTURE(outer[0]);
      CAPTURE(outer[2]);
      const Facing a = block.project({x, outer}), b = faceted.project({x, outer});
      CHECK(norm(a.normal - b.normal) < 1e-12);
      CHECK(a.gap == doctest::Approx(b.gap).epsilon(1e-12));
      CHECK(a.chosen == b.chosen);
    }
}
