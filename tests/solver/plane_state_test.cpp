// SPDX-License-Identifier: BSD-3-Clause
// Plane stress and axisymmetry against closed-form solutions.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

#include <kacanov/discretisation.hpp>
#include "half_space.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

constexpr double pi = std::numbers::pi;

Model model_of(PlaneState plane, const Law& law) {
  Model model;
  model.plane = plane;
  model.materials.push_back({everything(), law});
  model.solver.tolerance = 1e-8;
  return model;
}

/// A section of n × m cells that starts at (inner, 0).
Mesh section(ElementType type, double inner, const std::array<double, 2>& size, int n, int m) {
  Mesh mesh = make_box({{size[0], size[1], 0}, {n, m, 1}, type});
  map_nodes(mesh, [&](const Vector3& x) { return Vector3{x[0] + inner, x[1], 0}; });
  return mesh;
}

}  // namespace

TEST_CASE("plane stress: a bar in tension follows the curve that its material was given, exactly") {
  constexpr std::array<std::array<double, 2>, 3> rows{{{250, 0}, {320, 0.02}, {380, 0.08}}};
  constexpr double young = 210e3, poisson = 0.3;
  Law law = elastic_law(young, poisson);
  law.form = plastic_table(law, rows);
  for (const ElementType type : {ElementType::tri3, ElementType::quad4})
    for (const double stress : {100.0, 300.0, -350.0})
      for (const auto outer : {SolverOptions::Outer::kacanov, SolverOptions::Outer::newton}) {
        CAPTURE(cell(type).name);
        CAPTURE(stress);
        Model model = model_of(PlaneState::stress, law);
        model.boundary = {roller(named("left"), 0), roller(named("bottom"), 1),
                          traction(named("right"), {stress, 0, 0})};
        model.probes = {{3, 1, 0}};
        model.solver.outer = outer;
        model.solver.max_outer = 2000;
        const Run run = run_alone(section(type, 0.0, {3, 1}, 6, 2), model);
        REQUIRE(run.result().status == Status::converged);
        const double size = std::abs(stress);
        const double plastic = size <= 250.0   ? 0.0
                               : size <= 320.0 ? 0.02 * (size - 250.0) / 70.0
                                               : 0.02 + 0.06 * (size - 320.0) / 60.0;
        const double along = std::copysign(size / young + plastic, stress);
        const double across = -std::copysign(poisson * size / young + 0.5 * plastic, stress);
        CHECK(run.probe()[0] == doctest::Approx(3.0 * along).epsilon(1e-5));
        CHECK(run.probe()[1] == doctest::Approx(across).epsilon(1e-5));
        CHECK(run.result().max_von_mises == doctest::Approx(size).epsilon(1e-6));
        CHECK(run.result().plastic_elements == (plastic > 0.0 ? run.result().elements : 0));
      }
}

TEST_CASE("plane stress is that of a thin plate in 3D, beyond yield") {
  constexpr double thickness = 0.02;
  const Law law = hardening_law(0.005, 0.3);
  const Vector3 load{0, -4e-4, 0};
  Model flat = model_of(PlaneState::stress, law);
  flat.boundary = {moved(named("left"), 2), traction(named("right"), load)};
  flat.probes = {{4, 0.5, 0}};
  const Run plane = run_alone(section(ElementType::quad4, 0.0, {4, 1}, 32, 8), flat);
  Model model = model_of(PlaneState::strain, law);
  model.materials[0].bbar = false;
  model.boundary = {displacement(named("left"), {0.0, 0.0, std::nullopt}), roller(named("bottom"), 2),
                    traction(named("right"), load)};
  model.probes = {{4, 0.5, 0}};
  const Run solid = run_alone(make_box({{4, 1, thickness}, {32, 8, 1}, ElementType::hex8}), model);
  REQUIRE(plane.result().status == Status::converged);
  REQUIRE(solid.result().status == Status::converged);
  CHECK(plane.result().plastic_elements > 20);
  MESSAGE("plane ", plane.probe()[1], " solid ", solid.probe()[1]);
  for (std::size_t c = 0; c < 2; ++c)
    CHECK(plane.probe()[c] == doctest::Approx(solid.probe()[c]).epsilon(0.005));
  CHECK(plane.result().max_von_mises == doctest::Approx(solid.result().max_von_mises).epsilon(0.02));
}

TEST_CASE("round an axis is as a wedge in 3D, beyond yield") {
  constexpr double half = 0.02;  // half of the wedge's angle
  const Law law = hardening_law(0.005, 0.3);
  BoundaryEntry pressure;
  pressure.on = named("left");
  pressure.pressure = 0.012;
  Model flat = model_of(PlaneState::axisymmetric, law);
  flat.boundary = {moved(named("bottom"), 2), pressure};
  flat.probes = {{1, 1, 0}, {2, 1, 0}};
  const Run round = run_alone(section(ElementType::quad4, 1.0, {1, 1}, 12, 12), flat);
  Mesh mesh = make_box({{1, 1, 1}, {12, 12, 1}, ElementType::hex8});
  map_nodes(mesh, [](const Vector3& x) {
    const double angle = half * (2.0 * x[2] - 1.0);
    return Vector3{(1.0 + x[0]) * std::cos(angle), x[1], (1.0 + x[0]) * std::sin(angle)};
  });
  Model model = model_of(PlaneState::strain, law);
  model.boundary = {moved(named("front"), 3), pressure};
  for (const char* side : {"bottom", "top"}) {
    BoundaryEntry symmetry;
    symmetry.on = named(side);
    symmetry.normal = 0.0;
    model.boundary.push_back(symmetry);
  }
  model.probes = {{1, 1, 0}, {1.999, 1, 0}};
  const Run wedge = run_alone(mesh, model);
  REQUIRE(round.result().status == Status::converged);
  REQUIRE(wedge.result().status == Status::converged);
  CHECK(round.result().plastic_elements > 10);
  MESSAGE("round ", round.probe()[0], " wedge ", wedge.probe()[0]);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t c = 0; c < 2; ++c)
      CHECK(round.probe(p)[c] == doctest::Approx(wedge.probe(p)[c]).epsilon(0.003));
  CHECK(round.result().max_von_mises == doctest::Approx(wedge.result().max_von_mises).epsilon(0.003));
}

TEST_CASE("plane stress: a hole in a wide plate raises the stress threefold") {
  // A quarter: angles along the first axis, radii that grow geometrically along the second.
  constexpr int turns = 24, rings = 40;
  constexpr double outer = 30.0;
  Mesh mesh = make_box({{1, 1, 0}, {turns, rings, 1}, ElementType::quad4});
  map_nodes(mesh, [](const Vector3& x) {
    const double r = std::pow(outer, x[1]), angle = 0.5 * pi * (1.0 - x[0]);
    return Vector3{r * std::cos(angle), r * std::sin(angle), 0};
  });
  // The remote stress is uniform: prescribe its tractions on the outer boundary, cell by cell.
  Model model = model_of(PlaneState::stress, elastic_law(1.0, 0.3));
  model.boundary = {roller(named("left"), 0), roller(named("right"), 1)};
  for (int k = 0; k < turns; ++k) {
    const double a = 0.5 * pi * k / turns, b = 0.5 * pi * (k + 1) / turns, slack = 1e-6;
    const Vector3 low{outer * std::cos(b) - slack, outer * std::sin(a) - slack, 0},
        high{outer * std::cos(a) + slack, outer * std::sin(b) + slack, 0};
    model.boundary.push_back(traction(box(low, high), {0.001 * std::cos(0.5 * (a + b)), 0, 0}));
  }
  const Run run = run_alone(mesh, model);
  REQUIRE(run.result().status == Status::converged);
  const NodalStress found = recover_stress(run.part, run.solution.displacement);
  CHECK(found.max_von_mises.value / 0.001 == doctest::Approx(3.0).epsilon(0.03));
  CHECK(distance(found.max_von_mises.at, {0, 1, 0}) < 1e-9);
  for (std::size_t n = 0; n < run.part.nodes(); ++n) CHECK(std::abs(found.stress[6 * n + 2]) < 1e-12);
}

TEST_CASE("plane stress: a ring under inner pressure is Lamé's, of second order") {
  constexpr double young = 1.0, poisson = 0.3, p = 0.01, a = 1.0, b = 2.0;
  std::vector<double> errors;
  for (const int n : {8, 16}) {
    Mesh mesh = make_box({{1, 1, 0}, {n, 2 * n, 1}, ElementType::quad4});
    map_nodes(mesh, [](const Vector3& x) {
      const double angle = 0.5 * pi * x[1];
      return Vector3{(a + (b - a) * x[0]) * std::cos(angle), (a + (b - a) * x[0]) * std::sin(angle), 0};
    });
    Model model = model_of(PlaneState::stress, elastic_law(young, poisson));
    model.boundary = {roller(named("bottom"), 1), roller(named("top"), 0), pressure(named("left"), p)};
    model.probes = {{a, 0, 0}, {b, 0, 0}};
    const Run run = run_alone(mesh, model);
    REQUIRE(run.result().status == Status::converged);
    const double share = p * a * a / (b * b - a * a) / young;
    const double at_a = share * ((1 - poisson) * a + (1 + poisson) * b * b / a), at_b = share * 2.0 * b;
    CHECK(run.probe(0)[0] == doctest::Approx(at_a).epsilon(0.02));
    CHECK(run.probe(1)[0] == doctest::Approx(at_b).epsilon(0.02));
    errors.push_back(std::abs(run.probe(0)[0] / at_a - 1.0));
  }
  CHECK(errors[0] / errors[1] > 3.3);
}

TEST_CASE("round an axis: a cylinder that only the obstacle holds is pressed together as one") {
  for (const ElementType type : {ElementType::tri3, ElementType::quad4}) {
    constexpr double young = 100.0, poisson = 0.3, p = 0.5, radius = 1.5, height = 2.0;
    Model model = model_of(PlaneState::axisymmetric, elastic_law(young, poisson));
    model.boundary = {pressure(named("top"), p)};
    model.contact = {on_plane(named("bottom"), {}, {0, 1, 0})};
    model.probes = {{radius, height, 0}, {0, height, 0}};
    const Run run = run_alone(section(type, 0.0, {radius, height}, 6, 8), model);
    REQUIRE(run.result().status == Status::converged);
    CHECK(run.problem.loose_modes == 1);
    CHECK(mentions(run.problem.warnings.at(0), "translation along y"));
    CHECK(run.probe(0)[0] == doctest::Approx(poisson * p / young * radius).epsilon(1e-6));
    CHECK(run.probe(0)[1] == doctest::Approx(-p / young * height).epsilon(1e-6));
    CHECK(std::abs(run.probe(1)[0]) < 1e-15);
    CHECK(run.result().contact_force[1] == doctest::Approx(p * pi * radius * radius).epsilon(1e-6));
    CHECK(run.result().body.volume == doctest::Approx(pi * radius * radius * height));
    CHECK(run.result().max_contact_pressure == doctest::Approx(p).epsilon(1e-5));
    CHECK(run.result().certificate.force_balance < 1e-6);
  }
}

TEST_CASE(
    "round an axis: a warm disc that is free grows without stress, a ring that is held at its ends presses") {
  constexpr double young = 100.0, poisson = 0.3, alpha = 1e-3, rise = 10.0;
  BoundaryEntry warm;
  warm.on = everything();
  warm.temperature = rise;
  for (const ElementType type : {ElementType::tri3, ElementType::quad4}) {
    Model model = model_of(PlaneState::axisymmetric, elastic_law(young, poisson));
    model.materials[0].expansion = alpha;
    model.boundary = {roller(named("bottom"), 1), warm};
    model.probes = {{2, 1, 0}};
    const Run free = run_alone(section(type, 0.0, {2, 1}, 6, 4), model);
    REQUIRE(free.result().status == Status::converged);
    CHECK(free.probe()[0] == doctest::Approx(alpha * rise * 2.0).epsilon(1e-6));
    CHECK(free.probe()[1] == doctest::Approx(alpha * rise).epsilon(1e-6));
    model.boundary.push_back(roller(named("top"), 1));
    const Run held = run_alone(section(type, 1.0, {1, 1}, 6, 4), model);
    REQUIRE(held.result().status == Status::converged);
    CHECK(held.probe()[0] == doctest::Approx((1 + poisson) * alpha * rise * 2.0).epsilon(1e-6));
    CHECK(held.result().reaction.back().total.force[1] ==
          doctest::Approx(-young * alpha * rise * pi * 3.0).epsilon(1e-6));
  }
}

TEST_CASE("round an axis: the weight of a cone, and a bed of springs under it, by their volumes and areas") {
  for (const ElementType type : {ElementType::tri3, ElementType::quad4}) {
    Mesh mesh = section(type, 0.0, {1, 1}, 5, 5);
    map_nodes(mesh, [](const Vector3& x) { return Vector3{x[0] * (1.0 - 0.5 * x[1]), x[1], 0}; });
    Model model = model_of(PlaneState::axisymmetric, elastic_law(1e6, 0.3));
    model.boundary = {body_force(everything(), {0, -3.0, 0})};
    BoundaryEntry bed;
    bed.on = named("bottom");
    bed.spring = Vector3{0, 50.0, 0};
    model.boundary.push_back(bed);
    model.probes = {{0.5, 0, 0}};
    const Run run = run_alone(mesh, model);
    REQUIRE(run.result().status == Status::converged);
    const double volume = pi / 3.0 * (1.0 + 0.5 + 0.25);  // a frustum
    CHECK(run.result().body.volume == doctest::Approx(volume));
    CHECK(run.result().load.at(0).total.force[1] == doctest::Approx(-3.0 * volume));
    CHECK(run.result().load.at(0).total.moment == Vector3{});
    CHECK(run.probe()[1] == doctest::Approx(-3.0 * volume / (50.0 * pi)).epsilon(1e-3));
  }
}

TEST_CASE("round an axis: a sphere pressed into a block is Hertz's") {
  constexpr double young = 1.0, poisson = 0.3, radius = 100.0, contact = 1.0,
                   depth = contact * contact / radius;
  constexpr double stiff = young / (1.0 - poisson * poisson), force = 4.0 / 3.0 * stiff * depth * contact;
  HalfSpace space;
  space.n = 12;
  space.extent = 60.0;
  const double cells = space.cells();
  Mesh mesh = make_box({{cells, cells, 0}, {space.cells(), space.cells(), 1}, ElementType::quad4});
  map_nodes(mesh, [&](const Vector3& x) {
    return Vector3{space.coordinate(x[0]), space.coordinate(x[1]), 0};
  });
  Model model = model_of(PlaneState::axisymmetric, elastic_law(young, poisson));
  model.solver.tolerance = 1e-7;
  model.boundary = {moved(named("top"), 2), moved(named("right"), 2)};
  ContactEntry entry;
  entry.on = named("bottom");
  // The block lies above the ball; beyond its extent a half-space would still give way by F (1 − ν²)/(π E r).
  const double far = force / (pi * stiff * space.extent);
  entry.obstacle = Sphere{{0, depth - far - radius, 0}, radius, Vector3{0, -1, 0}};
  model.contact = {entry};
  const Run run = run_alone(mesh, model);
  REQUIRE(run.result().status == Status::converged);
  const double found = run.result().contact_force[1];
  MESSAGE("force over Hertz's ", found / force);
  CHECK(std::abs(found / force - 1.0) < 0.03);
  // For the computed force, independent of the far field.
  const double width = std::cbrt(0.75 * found * radius / stiff);
  CHECK(run.result().max_contact_pressure ==
        doctest::Approx(1.5 * found / (pi * width * width)).epsilon(0.02));
}

TEST_CASE("round an axis: what cannot be is refused with its place") {
  const auto refused = [](const Mesh& mesh, const Model& model, const std::string& text) {
    const std::string said = refusal(mesh, model);
    CHECK_MESSAGE(mentions(said, text), said);
  };
  const Mesh ring = section(ElementType::quad4, 1.0, {1, 1}, 2, 2),
             disc = section(ElementType::quad4, 0, {1, 1}, 2, 2);
  Model model = model_of(PlaneState::axisymmetric, elastic_law(1, 0.3));
  refused(ring, model, "nothing holds the body against translation along y;");
  model.boundary = {roller(named("bottom"), 1)};
  refused(section(ElementType::quad4, -0.5, {1, 1}, 2, 2), model,
          "plane: node 1 lies at x = -0.5; an axisymmetric mesh is a section with x ≥ 0");
  refused(make_box({{1, 1, 1}, {1, 1, 1}, ElementType::hex8}), model,
          "plane: expected \"strain\", or a mesh in 2D, got one in 3D");
  model.boundary.push_back(displacement(named("left"), {0.1, std::nullopt, std::nullopt}));
  CHECK(refusal(ring, model).empty());
  refused(disc, model,
          "boundary[1].displacement: node 1 at (0, 0) is given a displacement away from the axis");
  model.boundary.pop_back();
  model.contact = {on_plane(named("top"), {0, 1, 0}, {0, -1, 0})};
  model.contact[0].motion = Motion{{}, {{1.0, {0.1, 0, 0}, {}}}};
  refused(ring, model, "contact[0].motion.path[0]: expected a translation along y alone");
  model.contact[0].motion.reset();
  model.contact[0].force_controlled = ForceControl{1.0, {1, -1, 0}};
  refused(ring, model, "contact[0].force_controlled.direction: expected a direction along y");
  model = model_of(PlaneState::stress, elastic_law(1, 0.3));
  model.materials[0].bbar = true;
  model.boundary = {moved(named("bottom"), 2)};
  refused(ring, model, "material[0].bbar: expected false with plane stress");
}
