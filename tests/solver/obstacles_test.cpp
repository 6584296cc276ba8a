// SPDX-License-Identifier: BSD-3-Clause
// Obstacles seen from random points: signed distances and normals, rays, the tree of a surface, points
// equally near in several directions.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include <kacanov/obstacle.hpp>
#include <kacanov/surface.hpp>
#include "problem/error_tracking_double.hpp"
#include "problem/vector3.hpp"
#include "problem_models.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

Facing look(const Obstacle& obstacle, const Vector3& x) {
  return std::visit([&](const auto& kind) { return kind.project({x, {0, 0, 1}}); }, obstacle);
}

/// Right-handed axes of arbitrary length.
constexpr std::array<Vector3, 3> slanting_frame{Vector3{1, 0.2, 0.5}, Vector3{-0.2, 1, 0},
                                                Vector3{-0.5, -0.1, 1.04}};

class PointDice {
 public:
  double number(double low = -1.0, double high = 1.0) { return low + (high - low) * uniform_(bits_); }
  Vector3 vector() { return {number(), number(), number()}; }

 private:
  std::mt19937 bits_{20261122};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

/// A triangulated ball: an icosahedron refined `times`, corners on the unit sphere, oriented outwards.
Surface faceted_ball(int times) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vector3> points;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g})
      for (std::size_t c = 0; c < 3; ++c) {
        Vector3 x{};
        x[c] = s;
        x[(c + 1) % 3] = t;
        points.push_back((1 / norm(x)) * x);
      }
  std::vector<Surface::Triangle> faces;
  const auto near = [&](std::int32_t a, std::int32_t b) { return norm(points[a] - points[b]) < 1.1; };
  for (std::int32_t a = 0; a < 12; ++a)
    for (std::int32_t b = a + 1; b < 12; ++b)
      for (std::int32_t c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(a, c)) continue;
        const bool outwards = dot(cross(points[b] - points[a], points[c] - points[a]), points[a]) > 0;
        faces.push_back(outwards ? Surface::Triangle{a, b, c} : Surface::Triangle{a, c, b});
      }
  for (; times > 0; --times) {
    std::vector<Surface::Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const auto first = static_cast<std::int32_t>(points.size());
      for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        const Vector3 sum = points[std::min(p, q)] + points[std::max(p, q)];
        points.push_back((1 / norm(sum)) * sum);
      }
      for (const auto& face : {Surface::Triangle{a, first, first + 2},
                               {first, b, first + 1},
                               {first + 2, first + 1, c},
                               {first, first + 1, first + 2}})
        finer.push_back(face);
    }
    faces.swap(finer);
  }
  return Surface(points, faces);
}

std::shared_ptr<const Surface> shared_ball(int times) {
  return std::make_shared<const Surface>(faceted_ball(times));
}

std::string complaint(const Obstacle& obstacle) {
  try {
    std::visit([](const auto& kind) { kind.check(std::string("obstacle.") + kind.key); }, obstacle);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("an obstacle without direction is a signed distance: ν is its slope, and leads to the surface") {
  const std::vector<Obstacle> obstacles{Plane{{0.1, 0.2, -0.3}, {1, 2, 3}},
                                        Sphere{{0.1, 0, 0.2}, 0.7, {}},
                                        Sphere{{0.1, 0, 0.2}, 3.0, {}, true},
                                        Cylinder{{0.2, 0.1, 0}, {1, 1, 2}, 0.6, {}},
                                        Cylinder{{0.2, 0.1, 0}, {1, 1, 2}, 4.0, {}, true},
                                        Cone{{0, 0.1, 0.2}, {1, 0, -2}, 35.0, {}},
                                        Torus{{0.1, 0, 0}, {0, 1, 2}, 0.8, 0.3},
                                        Block{{-0.5, -0.4, -0.3}, {0.3, 0.6, 0.5}},
                                        Block{{-0.5, -0.4, -0.3}, {0.3, 0.6, 0.5}, slanting_frame},
                                        SurfaceObstacle{shared_ball(2)}};
  PointDice dice;
  for (const Obstacle& obstacle : obstacles)
    for (int trial = 0; trial < 200; ++trial) {
      CAPTURE(obstacle.index());
      const Vector3 x = 1.5 * dice.vector();
      const Facing here = look(obstacle, x);
      REQUIRE(here.kind == Facing::Kind::met);
      CHECK(norm(here.normal) == doctest::Approx(1.0).epsilon(1e-14));
      CHECK(std::abs(look(obstacle, x + here.gap * here.normal).gap) < 1e-13);
      // Distances are Lipschitz continuous with constant 1.
      const Vector3 step = 0.1 * dice.vector();
      CHECK(std::abs(look(obstacle, x + step).gap - here.gap) <= norm(step) * (1 + 1e-12));
      // Towards the nearest point the gap falls by the distance moved; only outside, because inside it may
      // have a kink.
      if (here.gap > 0)
        CHECK(look(obstacle, x + 0.3 * here.gap * here.normal).gap ==
              doctest::Approx(0.7 * here.gap).epsilon(1e-11));
    }
}

TEST_CASE("along a direction the gap is the way to the surface, from outside and from within") {
  PointDice dice;
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3 way = dice.vector(), unit_way = (1 / norm(way)) * way;
    for (const bool along : {true, false}) {
      const std::vector<Obstacle> seen{
          Sphere{{0.1, 0, 0.2}, 0.7, way}, Cylinder{{0.2, 0.1, 0}, {1, 1, 2}, 0.6, way},
          Cone{{0, 0.1, 0.2}, {1, 0, -2}, 35.0, along ? Vector3{1, 0, -2} : way}};
      const std::vector<Obstacle> plain{Sphere{{0.1, 0, 0.2}, 0.7, {}},
                                        Cylinder{{0.2, 0.1, 0}, {1, 1, 2}, 0.6, {}},
                                        Cone{{0, 0.1, 0.2}, {1, 0, -2}, 35.0, {}}};
      const Vector3 x = dice.vector();
      for (std::size_t k = 0; k < seen.size(); ++k) {
        CAPTURE(k);
        const Facing ray = look(seen[k], x);
        if (ray.kind != Facing::Kind::met) {
          // A ray that misses stays outside.
          for (int i = -40; i <= 40 && k < 2; ++i) CHECK(look(plain[k], x + (0.1 * i) * unit_way).gap > 0);
          continue;
        }
        const Vector3 foot = x + ray.gap * ray.normal;
        CHECK(std::abs(look(plain[k], foot).gap) < 1e-11 * (1 + std::abs(ray.gap)));
        CHECK(look(plain[k], foot - 1e-4 * ray.normal).gap > 0);
      }
    }
  }
  CHECK(look(Cylinder{{}, {0, 0, 1}, 1.0, Vector3{0, 0, -1}}, {2, 0, 0}).kind == Facing::Kind::missed);
  CHECK(look(Cone{{}, {0, 0, -1}, 80.0, Vector3{0, 0, -1}}, {0.5, 0, 0}).gap ==
        doctest::Approx(0.5 / std::tan(80 * M_PI / 180)));
}

TEST_CASE("a box is a box in the plane too, and 3D wants one of three lengths") {
  CHECK(look(Block{{-1, -2, 0}, {1, 0, 0}}, {0.3, 0.5, 0}).gap == 0.5);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("top"), {0.0, 0.0, 0.0}));
  model.contact.push_back({named("bottom"), Block{{-1, -2, 0}, {1, 0, 0}}, {}});
  CHECK_THROWS_WITH_AS(
      build_problem(box_mesh(ElementType::tet4), model),
      "contact[0].obstacle.box: expected corners of three entries that differ in all of them", InputError);
  model.contact[0].obstacle = SurfaceObstacle{};
  CHECK_THROWS_WITH_AS(build_problem(box_mesh(ElementType::tet4), model),
                       "contact[0].obstacle.surface: expected the obstacle's data, which are not read yet",
                       InputError);
  model.contact[0].obstacle = Cylinder{{0, 0, 0}, {1, 0, 0}, 0.5, {}};
  CHECK_THROWS_WITH_AS(
      build_problem(box_mesh(ElementType::tet4), model),
      doctest::Contains("lies on the axis, where no direction leads out; give a \"direction\""), InputError);
}

TEST_CASE("a tree finds what looking at every triangle finds, to the bit; a faceted ball is nearly a ball") {
  PointDice dice;
  for (const int times : {0, 2, 4}) {
    const Surface ball = faceted_ball(times);
    CHECK(ball.size() == static_cast<std::size_t>(20) << (2 * times));
    double worst = 0.0, edge = 0.0;
    for (std::size_t f = 0; f < ball.size(); ++f) {
      const auto corner = ball.corners(f);
      edge = std::max(edge, norm(ball.points()[corner[0]] - ball.points()[corner[1]]));
    }
    for (int trial = 0; trial < 300; ++trial) {
      const Vector3 x = 2.0 * dice.vector();
      const Surface::Closest a = ball.closest(x), b = ball.closest_of_all(x);
      CHECK(a.point == b.point);
      CHECK(a.normal == b.normal);
      CHECK_FALSE(a.border);
      const Facing found = SurfaceObstacle{std::make_shared<const Surface>(ball)}.project({x, {}});
      worst = std::max(worst, std::abs(found.gap - (norm(x) - 1)));
      if (trial == 20) break;
    }
    // The sagitta of a triangle's circumscribed circle.
    CHECK(worst <= 1.01 * (1 - std::sqrt(1 - edge * edge / 3)));
  }
}

TEST_CASE("the way to a surface close by has more digits than the coordinates") {
  // On the plane x + 2 y + 2 z = 0.
  const std::vector<Vector3> points{{0, 1000, -1000}, {2000, 0, -1000}, {-2000, 1000, 0}};
  const SurfaceObstacle tilted{
      std::make_shared<const Surface>(points, std::vector<Surface::Triangle>{{0, 1, 2}})};
  for (const double height : {1.0, 1e-2, 1e-4}) {
    const Vector3 x{height, 700 + 2 * height, -700 + 2 * height};
    const Facing found = tilted.project({x, {}});
    INFO("height ", height);
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(std::abs(std::abs(found.normal[c]) - (c == 0 ? 1.0 : 2.0) / 3) < 4e-16);
  }
}

TEST_CASE(
    "above an edge or a corner of coplanar triangles the direction is the plane's, the gap the way to it") {
  // Eight triangles around the centre of a square in x + 2 y + 2 z = 0, in two orders.
  const Vector3 u{2.0 / 3, 1.0 / 3, -2.0 / 3}, v{-2.0 / 3, 2.0 / 3, -1.0 / 3}, n{1.0 / 3, 2.0 / 3, 2.0 / 3};
  std::vector<Vector3> points;
  for (const double s : {-1.0, 0.0, 1.0})
    for (const double t : {-1.0, 0.0, 1.0}) points.push_back(1000.0 * s * u + 1000.0 * t * v);
  std::vector<Surface::Triangle> triangles;
  for (const std::int32_t a : {0, 1, 3, 4}) {
    triangles.push_back({a, a + 3, a + 4});
    triangles.push_back({a, a + 4, a + 1});
  }
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(triangles.begin(), triangles.end());
    const SurfaceObstacle square{std::make_shared<const Surface>(points, triangles)};
    for (const double height : {1.0, 1e-3, -1e-3})
      for (const double along : {0.0, 1e-13, -1e-13, 500.0}) {
        const Facing found = square.project({points[4] + along * u + height * n, n});
        INFO(turned, " ", height, " ", along);
        CHECK(found.kind == Facing::Kind::met);
        CHECK(norm(found.normal + n) < 1e-15);
        CHECK(std::abs(found.gap - height) < 1e-12);
      }
  }
}

TEST_CASE("beyond the border of an open surface there is nothing; folds and bad triangles are said") {
  const std::vector<Vector3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const auto square =
      std::make_shared<const Surface>(points, std::vector<Surface::Triangle>{{0, 1, 2}, {0, 2, 3}});
  const SurfaceObstacle open{square};
  CHECK(open.project({{0.5, 0.2, 0.3}, {}}).gap == 0.3);
  CHECK(open.project({{0.5, 0.2, -0.3}, {}}).gap == -0.3);
  CHECK(open.project({{0.5, 0.2, -0.3}, {}}).normal[2] == doctest::Approx(-1.0));
  CHECK(open.project({{0.0, 0.2, 0.3}, {}}).kind == Facing::Kind::met);
  CHECK(open.project({{-0.1, 0.2, 0.3}, {}}).kind == Facing::Kind::missed);
  const std::vector<Surface::Triangle> folded{{0, 1, 2}, {0, 2, 1}};
  const SurfaceObstacle leaf{std::make_shared<const Surface>(points, folded)};
  CHECK(leaf.project({{2, 0.5, 0}, {}}).kind == Facing::Kind::undecided);
  CHECK_THROWS_WITH_AS(Surface(points, {{0, 1, 7}}), "triangle 0: point 7 is not there", InputError);
  CHECK_THROWS_WITH_AS(Surface(points, {{0, 1, 1}}), "expected at least one triangle that has an area",
                       InputError);
}

TEST_CASE("heights: bilinear, the first row above, nothing beyond") {
  HeightField field{2, 3, {10, 20, 30, 0, 1, 2}, {0, 0}, {2, 1}};
  CHECK(field.at(0, 0).value().value == 0);
  CHECK(field.at(2, 1).value().value == 30);
  CHECK(field.at(0.5, 0.5).value().value == doctest::Approx((0.5 + 15) / 2));
  CHECK_FALSE(field.at(2.1, 0.5).has_value());
  CHECK_FALSE(field.at(1, -0.1).has_value());
  const auto shared = std::make_shared<const HeightField>(field);
  CHECK(HeightMap{shared, true}.project({{1, 0, 3}, {}}).gap == 2);
  CHECK(HeightMap{shared, false}.project({{1, 0, 3}, {}}).gap == -2);
  CHECK(HeightMap{shared, false}.project({{1, 0, 3}, {}}).normal == Vector3{0, 0, 1});
}

TEST_CASE("what is wrong with an obstacle is said with its key") {
  const std::map<std::string, Obstacle> rows{
      {"obstacle.cylinder.axis: expected a vector that is not zero, got [0,0,0]", Cylinder{}},
      {"obstacle.cylinder.radius: expected a number > 0, got -1", Cylinder{{}, {1, 0, 0}, -1.0, {}}},
      {"obstacle.cylinder.direction: expected no direction beside \"inside\": true",
       Cylinder{{}, {1, 0, 0}, 1.0, Vector3{0, 0, 1}, true}},
      {"obstacle.cone.half_angle: expected an angle in degrees above 0 and below 90, got 90",
       Cone{{}, {1, 0, 0}, 90.0, {}}},
      {"obstacle.torus.tube: expected a radius below that of the torus, 1, got 2",
       Torus{{}, {0, 0, 1}, 1.0, 2.0}},
      {"obstacle.box: expected a lower corner that is below the upper one in every direction, got [0,0,0] "
       "and "
       "[1,-1,1]",
       Block{{0, 0, 0}, {1, -1, 1}}},
      {"obstacle.box.frame[1]: expected an axis orthogonal to those before, got [1,1,0]",
       Block{{0, 0, 0}, {1, 1, 1}, std::array{Vector3{1, 0, 0}, Vector3{1, 1, 0}, Vector3{0, 0, 1}}}},
      {"obstacle.box: expected a lower corner that is below the upper one in every direction of the frame, "
       "got [0,0,0] and [1,1,1]",
       Block{{0, 0, 0}, {1, 1, 1}, std::array{Vector3{1, 1, 0}, Vector3{-1, 1, 0}, Vector3{0, 0, 1}}}},
      {"obstacle.height_map.upper[1]: expected a number above that of the lower corner, 3, got 2",
       HeightMap{std::make_shared<const HeightField>(HeightField{2, 2, {0, 0, 0, 0}, {1, 3}, {2, 2}})}}};
  for (const auto& [message, obstacle] : rows) CHECK(complaint(obstacle) == message);
}

TEST_CASE(
    "gaps of obstacles that are far larger than the body keep their digits, or say which they have lost") {
  PointDice dice;
  for (double size = 1.0; size < 1e31; size *= 8.0) {
    // All touch the plane z = 0 at the origin and deviate from it by terms of order 1/size.
    const std::vector<std::pair<Obstacle, double>> obstacles{
        {Plane{{size, -3 * size, 0}, {0, 0, 1}}, 0.0},
        {Sphere{{0, 0, -size}, size, {}}, 1.0},
        {Sphere{{0, 0, size}, size, {}, true}, -1.0},
        {Sphere{{0, 0, -size}, size, Vector3{0, 0, -1}}, 1.0},
        {Cylinder{{3, 0, -size}, {5, 0, 0}, size, {}}, 1.0},
        {Cylinder{{3, 0, -size}, {5, 0, 0}, size, Vector3{0, 0, -2}}, 1.0},
        {Torus{{0, 0, -size}, {1, 0, 0}, 0.75 * size, 0.25 * size}, 4.0},
        {Block{{-size, -size, -size}, {size, size, 0}}, 0.0},
        {Block{{-size, -size, -size},
               {size, size, 0},
               std::array{Vector3{4, 3, 0}, Vector3{-3, 4, 0}, Vector3{0, 0, 1}}},
         0.0}};
    for (const auto& one : obstacles) {
      const auto& obstacle = one.first;
      const auto& bend = one.second;
      CAPTURE(size);
      CAPTURE(obstacle.index());
      const Vector3 x{dice.number() / 4, dice.number() / 4, dice.number() / 4};
      const Facing found = look(obstacle, x);
      REQUIRE(found.kind == Facing::Kind::met);
      CHECK(found.unknown >= 0.0);
      CHECK(found.unknown < 1e-29 * size + 1e-15);
      // The gap is z plus terms of order (x² + y²)/size.
      CHECK(std::abs(found.gap - x[2]) <= std::abs(bend) / size + found.unknown + 1e-16);
    }
  }
  // The tangent of 45 degrees is accurate to long double only.
  for (double size = 1.0; size < 1e31; size *= 8.0) {
    const Facing found = look(Cone{{-size, 0, -size}, {1, 0, 0}, 45.0, {}}, {0, 0.1, 0.2});
    CHECK(found.unknown >= 1e-20 * size);
    CHECK(std::abs(found.gap - 0.2 / std::sqrt(2.0)) <= 0.01 / size + found.unknown + 1e-16);
  }
}

TEST_CASE("numbers of twice the precision hold their bounds") {
  PointDice dice;
  for (int trial = 0; trial < 1000; ++trial) {
    // (a + b)² − a² − b² = 2ab, and the square of a root, for numbers of any size.
    const double a = std::ldexp(dice.number(), static_cast<int>(dice.number(-60, 60)));
    const double b = std::ldexp(dice.number(), static_cast<int>(dice.number(-60, 60)));
    const Tracked sum = Tracked(a) + b, square = sum * sum - Tracked(a) * a - Tracked(b) * b;
    const Tracked wanted = Tracked(2.0 * a) * b, off = square - wanted;
    CHECK(std::abs(off.value()) <= square.error() + wanted.error());
    CHECK(square.error() <= 0x1p-99 * (a * a + b * b + std::abs(a * b)));
    const Tracked root = sqrt(Tracked(std::abs(a)) + b * b),
                  back = root * root - (Tracked(std::abs(a)) + b * b);
    CHECK(std::abs(back.value()) <= back.error());
    const Tracked share = Tracked(a) / b, whole = share * b - a;
    CHECK(std::abs(whole.value()) <= whole.error());
    CHECK(whole.error() <= 0x1p-99 * std::abs(a));
  }
  // Division by a number that may be zero has an unbounded error.
  const Tracked nothing = sqrt(Tracked(2.0)) * sqrt(Tracked(2.0)) - 2.0;
  CHECK_FALSE((Tracked(1.0) / nothing).error() < 1e300);
}

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
