// SPDX-License-Identifier: BSD-3-Clause
// Loads, prescribed displacements, materials and probes on meshes of all element types.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "problem/integration.hpp"
#include "problem/load_curves.hpp"
#include "problem/vector3.hpp"
#include "problem_models.hpp"

using namespace kacanov;
using namespace kacanov::testing;

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
