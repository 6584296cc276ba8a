// SPDX-License-Identifier: BSD-3-Clause
// Problems built from models on meshes of all element types: contact points, loads, prescribed displacements,
// materials, probes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "problem/integration.hpp"
#include "problem/load_curves.hpp"
#include "problem/vector3.hpp"
#include "problem_models.hpp"

using namespace kacanov::testing;
using namespace kacanov;

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

namespace {

struct Total {
  Vector3 force{}, moment{};
};

Total resultant(const Problem& problem) {
  Total sum;
  const std::size_t dim = problem.mesh.dim();
  for (std::size_t node = 0; node < problem.mesh.node_count(); ++node) {
    Vector3 f{};
    for (std::size_t c = 0; c < dim; ++c) f[c] = problem.load[node * dim + c];
    sum.force = sum.force + f;
    sum.moment = sum.moment + cross(position(problem.mesh, static_cast<std::int32_t>(node)), f);
  }
  return sum;
}

void check_equal(const Vector3& a, const Vector3& b, double tolerance = 1e-12) {
  CHECK(norm(a - b) <= tolerance * std::max(1.0, norm(b)));
}

Model held_at_left(int dim) {
  Model model = elastic_model();
  model.boundary.push_back(
      displacement(named("left"), {0.0, 0.0, dim == 3 ? std::optional<double>(0.0) : std::nullopt}));
  return model;
}

}  // namespace

TEST_CASE("a traction sums to itself times the area, and to the moment about any point") {
  for (const ElementType type : every_type) {
    const Mesh mesh = box_mesh(type);
    const bool flat = mesh.dim() == 2;
    Model model = held_at_left(mesh.dim());
    const Vector3 t{0.3, -0.7, flat ? 0.0 : 0.2};
    model.boundary.push_back(traction(named("right"), t));
    const Total sum = resultant(build_problem(mesh, model));
    const double area = flat ? 1.0 : 0.5;
    const Vector3 centre{2.0, 0.5, flat ? 0.0 : 0.25};
    check_equal(sum.force, area * t);
    check_equal(sum.moment, cross(centre, area * t));
  }
}

TEST_CASE("a pressure on one side pushes against the outer normal, on all sides it balances") {
  for (const ElementType type : every_type) {
    const Mesh mesh = box_mesh(type);
    const bool flat = mesh.dim() == 2;
    Model model = held_at_left(mesh.dim());
    model.boundary.push_back(pressure(named("right"), 2.0));
    check_equal(resultant(build_problem(mesh, model)).force, {flat ? -2.0 : -1.0, 0.0, 0.0});
    model.boundary.back().on = everything();
    const Total closed = resultant(build_problem(mesh, model));
    check_equal(closed.force, {});
    check_equal(closed.moment, {});
  }
}

TEST_CASE("a pressure balances on a closed curved surface") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    Mesh mesh = box_mesh(type);
    for (std::size_t node = 0; node < mesh.node_count(); ++node) {
      double* x = &mesh.coordinates[3 * node];
      const Vector3 old{x[0], x[1], x[2]};
      x[0] += 0.05 * std::sin(2.0 * old[1]);
      x[1] += 0.04 * old[0] * old[0];
      x[2] += 0.03 * old[0] * old[1];
    }
    Model model = held_at_left(3);
    model.boundary.push_back(pressure(everything(), 1.0));
    const Total closed = resultant(build_problem(mesh, model));
    check_equal(closed.force, {});
  }
}

TEST_CASE("a body force sums to itself times the volume, and acts in its centre") {
  for (const ElementType type : every_type) {
    const Mesh mesh = box_mesh(type);
    const bool flat = mesh.dim() == 2;
    Model model = held_at_left(mesh.dim());
    const Vector3 b{0.1, -9.0, flat ? 0.0 : 3.0};
    model.boundary.push_back(body_force(everything(), b));
    const Total sum = resultant(build_problem(mesh, model));
    const double volume = flat ? 2.0 : 1.0;
    check_equal(sum.force, volume * b);
    check_equal(sum.moment, cross({1.0, 0.5, flat ? 0.0 : 0.25}, volume * b));
    // A part of the body, selected by a box of elements.
    model.boundary.back().on = box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
    check_equal(resultant(build_problem(mesh, model)).force, 0.5 * volume * b);
  }
}

TEST_CASE("volume weights of a sheared tet10 and hex8 agree with their volume") {
  for (const ElementType type : {ElementType::tet10, ElementType::hex8}) {
    Mesh mesh = box_mesh(type);
    for (std::size_t node = 0; node < mesh.node_count(); ++node)
      mesh.coordinates[3 * node] += 0.3 * mesh.coordinates[3 * node + 1];
    double volume = 0.0;
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      for (const double w : volume_weights(mesh, e)) volume += w;
    }
    CHECK(volume == doctest::Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("displacements on several entries add up by component") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("left"), {0.0, std::nullopt, std::nullopt}));
  model.boundary.push_back(displacement(named("left"), {std::nullopt, 0.0, 0.0}));
  model.boundary.push_back(displacement(named("right"), {0.25, std::nullopt, std::nullopt}));
  const Problem problem = build_problem(mesh, model);
  for (std::size_t node = 0; node < mesh.node_count(); ++node) {
    const double x = mesh.coordinates[3 * node];
    for (std::size_t c = 0; c < 3; ++c) {
      const bool held = x == 0.0 || (x == 2.0 && c == 0);
      CHECK(problem.held[3 * node + c] == (held ? 1 : 0));
      CHECK(problem.prescribed[3 * node + c] == (x == 2.0 && c == 0 ? 0.25 : 0.0));
    }
  }
}

TEST_CASE("displacements that contradict each other at a shared edge are refused, equal ones are not") {
  const Mesh mesh = box_mesh(ElementType::hex8);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("left"), {0.0, 0.0, 0.0}));
  model.boundary.push_back(displacement(named("top"), {std::nullopt, std::nullopt, 0.0}));
  CHECK(refusal(mesh, model).empty());
  model.boundary.back().displacement = {std::nullopt, std::nullopt, -0.1};
  const std::string message = refusal(mesh, model);
  CHECK(mentions(message, "boundary[1].displacement: node "));
  CHECK(mentions(message, "z = -0.1 here and 0 by boundary[0]"));
}

TEST_CASE("what rounding leaves of a factor beside its entry's largest is 0") {
  Model model;
  model.boundary.resize(2);
  model.boundary[0].name = "wave";
  model.boundary[1].name = "small";
  for (int k = 1; k <= 4; ++k)
    model.steps.push_back(
        {static_cast<double>(k), {{"wave", std::sin(0.5 * std::numbers::pi * k)}, {"small", 1e-14 * k}}});
  const std::vector<LoadFactors> curves = load_curves(model);
  REQUIRE(curves.size() == 5);
  const double wave[] = {0.0, 1.0, 0.0, -1.0, 0.0};
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(curves[k].boundary[0] == wave[k]);
    CHECK(curves[k].boundary[1] == 1e-14 * static_cast<double>(k));
  }
}

TEST_CASE("a displacement may be given on a part that is made of nodes") {
  Mesh mesh = box_mesh(ElementType::tri3);
  mesh.groups.push_back({"pin", 0, {0}});
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("pin"), {0.0, 0.0, std::nullopt}));
  model.boundary.push_back(displacement(named("right"), {std::nullopt, 0.0, std::nullopt}));
  CHECK(build_problem(mesh, model).held[0] == 1);
  model.boundary.push_back(traction(named("pin"), {1.0, 0.0, 0.0}));
  CHECK(mentions(refusal(mesh, model),
                 "boundary[2].on: the part \"pin\" is made of nodes, expected boundary facets"));
}

TEST_CASE("every element has one material; only \"all\" may be overridden") {
  Mesh mesh = box_mesh(ElementType::tet4);
  const Selector half = box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
  Model model = held_at_left(3);
  model.materials.push_back({half, elastic_law(2.0, 0.3)});
  const Problem problem = build_problem(mesh, model);
  std::size_t second = 0;
  for (const std::uint16_t law : problem.law_of_element) second += law;
  CHECK(second == mesh.element_count() / 2);
  CHECK(problem.laws.size() == 2);

  model.materials.push_back({half, elastic_law(3.0, 0.3)});
  CHECK(mentions(refusal(mesh, model), "material[2].on: element 1 already has the material of material[1]"));
  model.materials.erase(model.materials.begin());
  model.materials.pop_back();
  Model locked = model;
  locked.materials[0].law.mean_dilatation = true;
  CHECK(mentions(refusal(mesh, locked), "material[0].bbar: expected false"));
  using Formulation = MaterialEntry::Formulation;
  Model mixed = model;
  mixed.materials[0].formulation = Formulation::mixed;
  Model flat = elastic_model();
  flat.materials[0].formulation = Formulation::mixed;
  CHECK(mentions(refusal(make_box({{1, 1, 0}, {2, 2, 1}, ElementType::tri3}), flat),
                 "material[0].formulation: expected displacement, or a mesh of tet4, tet10, hex8 or quad4"));
  mixed.materials[0].bbar = false;
  CHECK(mentions(refusal(mesh, mixed), "material[0].formulation: mixed is with bbar, which is false"));
  const std::string bare = refusal(mesh, model);
  CHECK(mentions(bare, "has no material (" + std::to_string(mesh.element_count() / 2)));
  CHECK(mentions(bare, "material: element "));
}

TEST_CASE("a probe reproduces linear fields, inside, at nodes and on the boundary") {
  for (const ElementType type : every_type) {
    const Mesh mesh = box_mesh(type);
    const bool flat = mesh.dim() == 2;
    Model model = held_at_left(mesh.dim());
    model.probes = {{0.3, 0.4, 0.1}, {2.0, 0.5, 0.5}, {0.0, 0.0, 0.0}, {1.0, 1.0 + 1e-9, 0.25}};
    if (flat) {
      for (Vector3& point : model.probes) point[2] = 0.0;
    }
    const Problem problem = build_problem(mesh, model);
    REQUIRE(problem.probes.size() == 4);
    for (const Probe& probe : problem.probes) {
      Vector3 x{};
      const std::size_t n = nodes_per_element(type);
      for (std::size_t k = 0; k < n; ++k) {
        x = x +
            probe.weights[k] * position(mesh, mesh.elements[static_cast<std::size_t>(probe.element) * n + k]);
      }
      check_equal(x, probe.point, 1e-10);
    }
    model.probes = {{1.0, 1.5, 0.0}};
    const std::string message = refusal(mesh, model);
    CHECK(mentions(message, "probe[0]: the point (1, 1.5"));
    CHECK(mentions(message, "is 0.5 away"));
  }
}
