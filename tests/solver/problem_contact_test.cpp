// SPDX-License-Identifier: BSD-3-Clause
// Contact points: masses, normals, gaps and traces, checked by hand.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "problem/vector3.hpp"
#include "problem_models.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// The bottom faces a plane slightly below; the top is clamped.
Model on_a_plane(int dim, double gap = 0.1) {
  Model model = elastic_model();
  const auto last = dim == 3 ? std::optional<double>(0.0) : std::nullopt;
  model.boundary.push_back(displacement(named("top"), {0.0, 0.0, last}));
  Plane plane;
  plane.point[dim - 1] = -gap;
  plane.normal[dim - 1] = 5.0;
  model.contact.push_back({named("bottom"), plane, std::nullopt});
  return model;
}

double total_mass(const Problem& problem) {
  double mass = 0.0;
  for (const ContactPoint& point : problem.contact) mass += point.mass;
  return mass;
}

}  // namespace

TEST_CASE("contact masses are positive and sum to the contact area") {
  for (const ElementType type : every_type) {
    const Mesh mesh = box_mesh(type);
    const Problem problem = build_problem(mesh, on_a_plane(mesh.dim()));
    CHECK(total_mass(problem) == doctest::Approx(2.0).epsilon(1e-12));
    for (std::size_t i = 0; i < problem.contact.size(); ++i) {
      const ContactPoint& point = problem.contact[i];
      REQUIRE(problem.contact.entries(i).size() == 1);
      const RowEntry& entry = problem.contact.entries(i).front();
      CHECK(entry.node == point.node);
      CHECK(entry.normal == point.normal);
      CHECK(point.mass > 0.0);
      CHECK(point.gap == doctest::Approx(0.1).epsilon(1e-12));
      CHECK(point.normal[mesh.dim() - 1] == doctest::Approx(-1.0));
      CHECK(entry.trace == point.normal);
      CHECK(point.tangents == 0);
    }
    CHECK(std::is_sorted(problem.contact.begin(), problem.contact.end(),
                         [](const auto& a, const auto& b) { return a.node < b.node; }));
  }
}

TEST_CASE("the end nodes of an edge carry half of what the inner ones do") {
  const Problem problem = build_problem(box_mesh(ElementType::tri3), on_a_plane(2));
  for (const ContactPoint& point : problem.contact) {
    const double x = position(problem.mesh, point.node)[0];
    CHECK(point.mass == doctest::Approx(x == 0.0 || x == 2.0 ? 0.25 : 0.5));
  }
}

TEST_CASE("a constant gap lies along the body's outer normal, whatever its sign") {
  for (const ElementType type : every_type) {
    const Mesh mesh = box_mesh(type);
    Model model = on_a_plane(mesh.dim());
    model.contact[0].obstacle = ConstantGap{-0.02};
    for (const ContactPoint& point : build_problem(mesh, model).contact) {
      CHECK(point.gap == -0.02);
      CHECK(point.normal[mesh.dim() - 1] == doctest::Approx(-1.0));
    }
  }
}

TEST_CASE("a sphere seen along a direction: the gap is the ray's, misses are no contact points") {
  const Mesh mesh = make_box({{1.0, 1.0, 1.0}, {8, 8, 8}, ElementType::hex8});
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("bottom"), {0.0, 0.0, 0.0}));
  Sphere sphere{{0.5, 0.5, 1.59}, 0.6, Vector3{0.0, 0.0, 3.0}};
  model.contact.push_back({named("top"), sphere, std::nullopt});
  const Problem problem = build_problem(mesh, model);
  std::size_t inside = 0;
  for (std::size_t node = 0; node < mesh.node_count(); ++node) {
    const double* x = &mesh.coordinates[3 * node];
    if (x[2] == 1.0 && std::hypot(x[0] - 0.5, x[1] - 0.5) <= 0.6) ++inside;
  }
  CHECK(problem.contact.size() == inside);
  CHECK(inside < 81);
  for (const ContactPoint& point : problem.contact) {
    const Vector3 x = position(mesh, point.node);
    const double across = std::hypot(x[0] - 0.5, x[1] - 0.5);
    CHECK(point.gap == doctest::Approx(0.59 - std::sqrt(0.36 - across * across)).epsilon(1e-12));
    CHECK(point.normal == Vector3{0.0, 0.0, 1.0});
    if (across == 0.0) CHECK(point.gap == doctest::Approx(-0.01));
  }
}

TEST_CASE("a sphere without direction: the closest point of each node") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = on_a_plane(3);
  model.contact[0].obstacle = Sphere{{1.0, 0.5, -3.0}, 2.5, std::nullopt};
  for (const ContactPoint& point : build_problem(mesh, model).contact) {
    const Vector3 to_centre = Vector3{1.0, 0.5, -3.0} - position(mesh, point.node);
    CHECK(point.gap == doctest::Approx(norm(to_centre) - 2.5).epsilon(1e-12));
    CHECK(norm(cross(point.normal, to_centre)) < 1e-12);
    CHECK(dot(point.normal, to_centre) > 0.0);
  }
}

TEST_CASE("tangents are orthonormal, normal to the trace and free of held components") {
  const Mesh mesh = box_mesh(ElementType::hex8);
  Model model = on_a_plane(3);
  model.boundary.push_back(displacement(named("left"), {0.0, std::nullopt, std::nullopt}));
  model.boundary.push_back(displacement(named("right"), {0.0, 0.0, std::nullopt}));
  Plane tilted{{0.0, 0.0, -0.5}, {0.3, 0.4, 1.2}};
  model.contact[0] = {named("bottom"), tilted, Friction{0.02, 0.0}};
  const ConstraintRows contact = build_problem(mesh, model).contact;
  for (std::size_t i = 0; i < contact.size(); ++i) {
    const ContactPoint& point = contact[i];
    const RowEntry& entry = contact.entries(i).front();
    const double x = position(mesh, point.node)[0];
    const int free = x == 0.0 ? 2 : x == 2.0 ? 1 : 3;
    CHECK(point.tangents == free - 1);
    CHECK(point.tresca == 0.02);
    CHECK(norm(point.normal) == doctest::Approx(1.0));
    if (free < 3) CHECK(entry.trace[0] == 0.0);
    if (free < 2) CHECK(entry.trace[1] == 0.0);
    for (std::size_t a = 0; a < static_cast<std::size_t>(point.tangents); ++a) {
      CHECK(std::abs(dot(entry.tangent[a], entry.trace)) < 1e-14);
      if (free < 3) CHECK(point.tangent[a][0] == 0.0);
      for (std::size_t b = 0; b <= a; ++b) {
        CHECK(dot(point.tangent[a], point.tangent[b]) == doctest::Approx(a == b ? 1.0 : 0.0));
      }
    }
  }
}

TEST_CASE("tet10: a corner that stands out towards its obstacle is told of, one that does not is not") {
  const auto warned = [](int cells, const Vector3& normal) {
    Model model = elastic_model();
    model.boundary.push_back(displacement(named("top"), {0.0, 0.0, 0.0}));
    ContactEntry contact;
    contact.on = named("bottom");
    if (norm(normal) > 0.0)
      contact.obstacle = Plane{{}, normal};
    else
      contact.obstacle = Sphere{{0.5, 0.5, -0.48}, 0.5, std::nullopt};
    model.contact.push_back(contact);
    const Mesh mesh = make_box({{1, 1, 1}, {cells, cells, cells}, ElementType::tet10});
    const auto warnings = build_problem(mesh, model).warnings;
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const std::string& w) { return mentions(w, "is a corner of quadratic facets"); });
  };
  CHECK(warned(2, {}));
  CHECK_FALSE(warned(8, {}));
  CHECK_FALSE(warned(2, {0, 0, 1}));
  CHECK_FALSE(warned(2, {0.02, 0.02, 1}));
  CHECK(warned(2, {0.3, 0.3, 1}));
}

TEST_CASE("displacement wins: nodes held along the normal are no contact points") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = on_a_plane(3);
  const std::size_t before = build_problem(mesh, model).contact.size();
  model.boundary.push_back(displacement(named("left"), {std::nullopt, std::nullopt, 0.0}));
  const Problem problem = build_problem(mesh, model);
  CHECK(problem.contact.size() == before - 3);
  for (const ContactPoint& point : problem.contact) CHECK(position(mesh, point.node)[0] > 0.0);
}

TEST_CASE("what a prescribed component closes is taken from the gap") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = on_a_plane(3);
  model.boundary.push_back(displacement(named("bottom"), {0.1, std::nullopt, std::nullopt}));
  model.contact[0].obstacle = Plane{{0.0, 0.0, -0.5}, {0.6, 0.0, 0.8}};
  const ConstraintRows contact = build_problem(mesh, model).contact;
  for (std::size_t i = 0; i < contact.size(); ++i) {
    const ContactPoint& point = contact[i];
    const Vector3 x = position(mesh, point.node);
    const double undeformed = dot(x - Vector3{0.0, 0.0, -0.5}, Vector3{0.6, 0.0, 0.8});
    CHECK(point.gap == doctest::Approx(undeformed + 0.6 * 0.1).epsilon(1e-12));
    CHECK(contact.entries(i).front().trace[0] == 0.0);
    CHECK(contact.entries(i).front().normal == point.normal);
  }
}

TEST_CASE("a node of two entries is two points in a corner and one on a plane") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = on_a_plane(3);
  const Obstacle plane = model.contact[0].obstacle;
  model.contact.clear();
  const Selector lower = box({0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}), upper = box({1.0, 0.0, 0.0}, {2.0, 1.0, 0.0});
  model.contact.push_back({lower, plane, Friction{0.03, 0.0}});
  model.contact.push_back({upper, plane, Friction{0.01, 0.0}});
  const Problem merged = build_problem(mesh, model);
  CHECK(merged.contact.size() == 15);
  CHECK(total_mass(merged) == doctest::Approx(2.0));
  for (const ContactPoint& point : merged.contact) {
    const double x = position(mesh, point.node)[0];
    CHECK((x < 1.0   ? point.tresca == 0.03
           : x > 1.0 ? point.tresca == 0.01
                     : point.tresca > 0.01 && point.tresca < 0.03));
  }
  model.contact[0].on = named("bottom");
  model.contact[1] = {named("left"), ConstantGap{0.1}, std::nullopt};
  CHECK(build_problem(mesh, model).contact.size() == 15 + 6);  // the left side's top nodes are clamped
}

TEST_CASE("contact that cannot be is refused") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = on_a_plane(3);
  SUBCASE("nothing selected") {
    model.contact[0].on = box({5.0, 5.0, 5.0}, {6.0, 6.0, 6.0});
    CHECK(mentions(refusal(mesh, model),
                   "contact[0].on: the box from (5, 5, 5) to (6, 6, 6) holds no boundary facet"));
  }
  SUBCASE("a facet twice") {
    model.contact.push_back(model.contact[0]);
    CHECK(mentions(refusal(mesh, model), "already belongs to contact[0]"));
  }
  SUBCASE("all held") {
    model.contact[0].on = named("top");
    CHECK(mentions(refusal(mesh, model), "contact[0]: none of the 15 nodes can touch the obstacle"));
  }
  SUBCASE("all missed") {
    model.contact[0].obstacle = Sphere{{50.0, 0.0, -3.0}, 1.0, Vector3{0.0, 0.0, -1.0}};
    CHECK(mentions(refusal(mesh, model), "contact[0]: none of the 15 nodes can touch the obstacle"));
  }
  SUBCASE("zero normal") {
    model.contact[0].obstacle = Plane{};
    CHECK(mentions(refusal(mesh, model),
                   "contact[0].obstacle.plane.normal: expected a vector that is not zero"));
  }
  SUBCASE("a node in the sphere's centre") {
    model.contact[0].obstacle = Sphere{};
    CHECK(mentions(refusal(mesh, model), "lies at the centre"));
  }
}
