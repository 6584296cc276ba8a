// SPDX-License-Identifier: BSD-3-Clause
// Recovered nodal stress, element fields and the error estimate: exact where theory says so, batched as one
// by one, independent of the number of ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <kacanov/discretisation.hpp>
#include <kacanov/part.hpp>
#include "recovery/element_batch.hpp"
#include "recovery/error_quadrature.hpp"
#include "recovery/spr_patches.hpp"
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

Problem stress_block(ElementType type, const std::vector<MaterialEntry>& materials, int cells = 2) {
  Mesh mesh = box_mesh(type, {2.0, 1.0, 1.0}, cells);
  Model model;
  model.materials = materials;
  model.boundary.push_back(moved(named("left"), mesh.dim()));
  return build_problem(mesh, model);
}

constexpr double half_width = 20.0;

/// A quarter of a square plate with a hole of radius 1: 24 elements per turn, of aspect ratio one at the
/// hole.
Mesh plate_with_hole() {
  Mesh mesh = make_box({{1.0, 1.0, 0.3}, {11, 6, 1}, ElementType::tet10});
  map_nodes(mesh, [](const Vector3& x) {
    const double angle = 0.5 * std::numbers::pi * x[1], c = std::cos(angle), s = std::sin(angle);
    const double r = std::pow(half_width / std::max(c, s), x[0]);
    return Vector3{r * c, r * s, x[2]};
  });
  return mesh;
}

}  // namespace

TEST_CASE("even stress is met at every node of every element") {
  for (const ElementType type : element_types()) {
    CAPTURE(static_cast<int>(type));
    const Problem problem = stress_block(type, {{everything(), elastic_law(1.0, 0.25)}});
    const Part part = over_all_ranks(problem);
    const int dim = part.dim();
    const NodalStress found =
        recover_stress(part, nodal_field(part, [](const Vector3& x) {
                         return Vector3{0.3 * x[0] + 0.1 * x[1], -0.2 * x[1], 0.1 * x[2]};
                       }));
    const double trace = dim == 3 ? 0.2 : 0.1, bulk = 1.0 / 1.5, mu = 0.4;
    const std::array<double, 3> strain{0.3, -0.2, dim == 3 ? 0.1 : 0.0};
    for (std::size_t n = 0; n < part.nodes(); ++n) {
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(found.stress[6 * n + c] == doctest::Approx(bulk * trace + 2 * mu * (strain[c] - trace / 3)));
      CHECK(found.stress[6 * n + 3] == doctest::Approx(mu * 0.1));
    }
    CHECK(found.max_von_mises.value == doctest::Approx(found.von_mises[0]));
  }
}

TEST_CASE("quadratic displacements of tet10 give their linear stress, at middles of edges too") {
  const Problem problem = stress_block(ElementType::tet10, {{everything(), elastic_law(1.0, 0.0)}});
  const Part part = over_all_ranks(problem);
  const NodalStress found = recover_stress(part, nodal_field(part, [](const Vector3& x) {
                                             return Vector3{x[0] * x[1], 0, 0};
                                           }));
  for (std::size_t n = 0; n < part.nodes(); ++n) {
    const double x = part.coordinates[3 * n], y = part.coordinates[3 * n + 1];
    CHECK(std::abs(found.stress[6 * n] - y) < 1e-6);
    CHECK(std::abs(found.stress[6 * n + 3] - 0.5 * x) < 1e-6);
  }
}

TEST_CASE("materials are kept apart; where they meet the larger stress is shown") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(static_cast<int>(type));
    const Problem problem = stress_block(
        type, {{everything(), elastic_law(1.0, 0.0)}, {box({0, 0, 0}, {1, 1, 1}), elastic_law(10.0, 0.0)}});
    const Part part = over_all_ranks(problem);
    const NodalStress found = recover_stress(part, nodal_field(part, [](const Vector3& x) {
                                               return Vector3{0.1 * x[0], 0, 0};
                                             }));
    for (std::size_t n = 0; n < part.nodes(); ++n)
      CHECK(found.stress[6 * n] == doctest::Approx(part.coordinates[3 * n] <= 1.0 + 1e-9 ? 1.0 : 0.1));
    CHECK(found.max_von_mises.value == doctest::Approx(1.0));
  }
}

TEST_CASE("laws of a batch share no node, on any rank, and are few batches") {
  const Mesh mesh = make_box({{12.0, 4.0, 4.0}, {12, 4, 4}, ElementType::hex8});
  Model model;
  for (double x = 0.0; x < 12.0; ++x)
    for (double y = 0.0; y < 4.0; ++y)
      for (double z = 0.0; z < 4.0; ++z)
        model.materials.push_back({box({x, y, z}, {x + 1.0, y + 1.0, z + 1.0}), elastic_law(1.0 + x, 0.3)});
  model.boundary.push_back(moved(named("left"), mesh.dim()));
  const Part part = over_all_ranks(build_problem(mesh, model));
  const std::vector<std::int32_t> batch = law_batches(part);
  const std::int32_t last = *std::max_element(batch.begin(), batch.end());
  CHECK(last < 27);  // an element has 26 neighbours
  std::vector<std::int64_t> elements(part.nodes());
  for (std::int32_t b = 0; b <= last; ++b) {
    std::fill(elements.begin(), elements.end(), 0);
    for (std::size_t e = 0; e < part.element_count(); ++e)
      for (std::size_t a = 0; a < 8; ++a)
        elements[part.elements[8 * e + a]] += batch[part.law_of_element[e]] == b ? 1 : 0;
    part.node_map.sum(elements, 1);
    CHECK(*std::max_element(elements.begin(), elements.end()) <= 1);  // each element has its own law
  }
}

TEST_CASE("a hole in a plate in tension: three times the stress, within 3 %") {
  const Mesh mesh = plate_with_hole();
  Model model = elastic_model();
  model.materials[0].law = elastic_law(1.0, 0.0);
  model.boundary.push_back(roller(named("front"), 1));
  model.boundary.push_back(roller(named("back"), 0));
  model.boundary.push_back(roller(named("bottom"), 2));
  model.boundary.push_back(traction(box({half_width, 0, 0}, {half_width, half_width, 0.3}), {0.001, 0, 0}));
  model.solver.tolerance = 1e-8;
  const Problem problem = build_problem(mesh, model);
  const Part part = over_all_ranks(problem);
  const Solution solution = solve(part, model.solver, {});
  REQUIRE(solution.result.status == Status::converged);
  const NodalStress found = recover_stress(part, solution.displacement);
  // Heywood: 2 + (1 − d/W)³ times the net stress, for d/W = 0.05.
  const double net = 1.0 / 0.95, expected = (2.0 + std::pow(0.95, 3)) * net;
  CHECK(found.max_von_mises.value / 0.001 == doctest::Approx(expected).epsilon(0.03));
  CHECK(distance({0, 1, found.max_von_mises.at[2]}, found.max_von_mises.at) < 1e-9);
  // Element means are far from it.
  CHECK(solution.result.max_von_mises / 0.001 < 2.8);
  MESSAGE("stress concentration ", found.max_von_mises.value / 0.001, ", of elements ",
          solution.result.max_von_mises / 0.001);
  // All copies are bitwise equal, and agree with a run on one rank.
  const Run alone = run_alone(mesh, model);
  CHECK(recover_stress(alone.part, alone.solution.displacement).max_von_mises.value ==
        doctest::Approx(found.max_von_mises.value).epsilon(1e-6));
  std::vector<double> copies = found.von_mises;
  part.node_map.forward(copies, 1);
  CHECK(copies == found.von_mises);
}

TEST_CASE(
    "warmth that nothing gives way to is a pressure in every stress that is told, and in none of von Mises") {
  for (const ElementType type : {ElementType::tri3, ElementType::tet10, ElementType::hex8}) {
    const int dim = dimension(type);
    Model model = elastic_model();
    model.materials[0].expansion = 1e-3;
    model.boundary.push_back(moved(everything(), dim));
    BoundaryEntry warm;
    warm.on = everything();
    warm.temperature = 10.0;
    model.boundary.push_back(warm);
    const Run run = run_alone(make_box({{1, 1, 1}, {2, 2, 2}, type}), model);
    REQUIRE(run.result().status == Status::converged);
    const double pressure = 1e-2 / (1 - 2 * 0.3);  // E α ΔT / (1 − 2ν)
    const auto check = [&](const std::vector<double>& stress) {
      for (std::size_t k = 0; k < stress.size(); ++k)
        CHECK(std::abs(stress[k] - (k % 6 < 3 ? -pressure : 0.0)) < 1e-6 * pressure);
    };
    const NodalStress nodal = recover_stress(run.part, run.solution);
    check(nodal.stress);
    CHECK(nodal.max_von_mises.value < 1e-6 * pressure);
    visit_element_fields(run.part, run.solution, [&](const ElementRun& fields) { check(fields.stress); });
  }
}

TEST_CASE("the finer rules integrate what they should") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const Cell& shape = cell(type);
    const int degree = 2 * shape.order;
    // ∫ x^p over the reference cell: p! dim!/(p + dim)! of a simplex's volume; by axes for a cube.
    for (int p = 0; p <= degree; ++p) {
      double sum = 0.0, expected = 1.0;
      for (const QuadraturePoint& point : error_quadrature(shape)) {
        CHECK(point.weight > 0.0);
        sum += point.weight * std::pow(point.xi[0], p);
      }
      if (shape.simplex)
        for (int i = 1; i <= shape.dim; ++i) expected /= p + i;
      else
        expected = (p % 2 == 0 ? 2.0 / (p + 1) : 0.0) * (shape.dim == 3 ? 4.0 : 2.0);
      CHECK(sum == doctest::Approx(expected).epsilon(1e-12).scale(1.0));
    }
  }
}

TEST_CASE("no error is seen where strains are even") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const int dim = dimension(type);
    Model model = bent_model(dim, elastic_law(1.0, 0.3));
    const Problem problem = build_problem(box_mesh(type), model);
    const Part part = over_all_ranks(problem);
    const DiscretisationError error =
        estimate_error(part, nodal_field(part, [](const Vector3& x) {
                         return Vector3{0.3 * x[0] + 0.1 * x[1], -0.2 * x[1], 0.1 * x[2]};
                       }));
    CHECK(error.stored > 0.0);
    CHECK(error.relative < 1e-7);
  }
}

TEST_CASE("linear strains of straight elements: their known distance from even ones") {
  // u = (0, x²/2) has the strain ε_xy = x/2; its interpolant's strain is known on each element: (x_left +
  // h/2)/2 on quad4 and hex8 of width h, so that ∫ 4 μ (ε − ε_h)² is μ h²/12 per unit of volume.
  for (const ElementType type : {ElementType::quad4, ElementType::hex8}) {
    CAPTURE(cell(type).name);
    const int cells = 8;
    const int dim = dimension(type);
    const Problem problem =
        build_problem(make_box({{1.0, 1.0, 1.0}, {cells, cells, dim == 3 ? cells : 1}, type}),
                      bent_model(dim, elastic_law(1.0, 0.0)));
    const Part part = over_all_ranks(problem);
    const DiscretisationError error = estimate_error(part, nodal_field(part, [](const Vector3& x) {
                                                       return Vector3{0.0, 0.5 * x[0] * x[0], 0.0};
                                                     }));
    const double h = 1.0 / cells, mu = 0.5;
    CHECK(error.energy == doctest::Approx(0.5 * mu * h * h / 12.0).epsilon(0.02));
  }
}

TEST_CASE("any number of ranks estimates the same") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const int dim = dimension(type);
    Model model = bent_model(dim, logarithmic_law(0.002));
    model.materials.push_back({box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), elastic_law(3.0, 0.2)});
    const Problem problem = build_problem(box_mesh(type), model);
    const auto field = [](const Vector3& x) {
      return Vector3{0.01 * x[0] * x[1], std::sin(x[0]) * 0.02, 0.01 * x[2] * x[0]};
    };
    const Part all = over_all_ranks(problem), alone = distribute(&problem, MPI_COMM_SELF);
    const DiscretisationError many = estimate_error(all, nodal_field(all, field));
    const DiscretisationError one = estimate_error(alone, nodal_field(alone, field));
    CHECK(many.energy == doctest::Approx(one.energy).epsilon(1e-9));
    CHECK(many.stored == doctest::Approx(one.stored).epsilon(1e-12));
    for (std::size_t e = 0; e < all.element_count(); ++e)
      CHECK(many.element[e] == doctest::Approx(one.element[all.element_index[e]]).epsilon(1e-6));
  }
}

TEST_CASE("errors of numbers from meshes of falling width") {
  CHECK(!error_of_last(std::vector<double>{1.0}).has_value());
  CHECK(*error_of_last(std::vector<double>{1.0, 1.0}) == 0.0);
  // 2 + 3 h²: the error is a third of the last difference; three values determine the order.
  CHECK(*error_of_last(std::vector<double>{5.0, 2.75}) == doctest::Approx(0.75));
  CHECK(*error_of_last(std::vector<double>{5.0, 2.75, 2.1875}) == doctest::Approx(0.1875));
  // 2 + 3 h: first order.
  CHECK(*error_of_last(std::vector<double>{5.0, 3.5, 2.75}) == doctest::Approx(0.75));
  // Differences that do not decrease give no extrapolation; the last difference is the estimate.
  CHECK(*error_of_last(std::vector<double>{1.0, 1.1, 1.3}) == doctest::Approx(0.2));
}

namespace {

void check_near(std::span<const double> found, std::span<const double> expected) {
  double largest = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    largest = std::max(largest, std::abs(expected[i]));
    apart = std::max(apart, std::abs(found[i] - expected[i]));
  }
  CHECK(largest > 0.0);
  CHECK(apart < 1e-12 * largest);
}

struct Fields {
  std::vector<double> stress, von_mises, dev_strain, secant, strain, rotation, volume;
  std::vector<std::uint8_t> plastic;
  explicit Fields(std::size_t n)
      : stress(6 * n),
        von_mises(n),
        dev_strain(n),
        secant(n),
        strain(n),
        rotation(n),
        volume(n),
        plastic(n) {}
  reference::ElementFields all() {
    return {stress, von_mises, dev_strain, secant, plastic, strain, rotation, volume};
  }
};

struct Points {
  std::vector<Vector3> position;
  std::vector<double> stress, strain, volume;
  explicit Points(std::size_t n) : position(n), stress(6 * n), strain(6 * n), volume(n) {}
  reference::PointFields all() { return {position, stress, strain, volume}; }
};

constexpr ElementType batched_types[] = {ElementType::tet4, ElementType::tet10, ElementType::hex8};

void compare_with_reference(ElementType type, bool mean_dilatation) {
  const FieldLoops& fast = field_loops(type);
  CAPTURE(cell(type).name);
  CAPTURE(mean_dilatation);
  Mesh mesh = box_mesh(type, {2.0, 1.0, 1.0}, 3);
  map_nodes(mesh, [](const Vector3& x) {
    return Vector3{x[0] + 0.1 * std::sin(3.0 * x[1]), x[1] + 0.05 * x[0] * x[2], 1.2 * x[2]};
  });
  std::vector<double> u(mesh.coordinates.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 0.02 * std::sin(1.7 * static_cast<double>(i));
  Law log = elastic_law(1.0, 0.3), linear = elastic_law(3.0, 0.45);
  log.form = laws::Logarithmic{0.01};
  log.mean_dilatation = mean_dilatation;
  const std::vector<Law> laws{log, linear};
  const auto npe = static_cast<std::size_t>(nodes_per_element(type));
  const auto points_each = static_cast<std::size_t>(points_per_element(type));
  for (const std::size_t elements :
       {std::size_t{1}, std::size_t{16}, std::size_t{37}, mesh.element_count()}) {
    if (elements > mesh.element_count()) continue;
    CAPTURE(elements);
    std::vector<std::uint16_t> law_of_element(elements);
    for (std::size_t e = 0; e < elements; ++e) law_of_element[e] = e % 3 == 2 ? 1 : 0;
    MeshView view = mesh.view();
    view.connectivity = view.connectivity.first(npe * elements);
    const Body body{view, laws, law_of_element};

    Fields found(elements), expected(elements);
    fast.fields(body, u, found.all());
    reference::fields(body, u, expected.all());
    check_near(found.stress, expected.stress);
    check_near(found.von_mises, expected.von_mises);
    check_near(found.dev_strain, expected.dev_strain);
    check_near(found.secant, expected.secant);
    check_near(found.strain, expected.strain);
    check_near(found.rotation, expected.rotation);
    check_near(found.volume, expected.volume);
    CHECK(found.plastic == expected.plastic);

    Points points(elements * points_each), as_reference(elements * points_each);
    fast.point_fields(body, u, points.all());
    reference::point_fields(body, u, as_reference.all());
    check_near(points.stress, as_reference.stress);
    check_near(points.strain, as_reference.strain);
    check_near(points.volume, as_reference.volume);
    for (std::size_t k = 0; k < points.position.size(); ++k)
      check_near(points.position[k], as_reference.position[k]);

    std::vector<double> volume(elements), reference_volume(elements);
    fast.volumes(body, volume);
    reference::volumes(body, reference_volume);
    check_near(volume, reference_volume);
    CHECK(fast.energy(body, u) == doctest::Approx(reference::energy(body, u)).epsilon(1e-12));
  }
}

}  // namespace

TEST_CASE("batches of elements have the fields of the reference") {
  for (const ElementType type : batched_types) compare_with_reference(type, false);
  for (const ElementType type : batched_types) compare_with_reference(type, true);
}

TEST_CASE("fields that are not requested stay unchanged") {
  for (const ElementType type : batched_types) {
    const FieldLoops& fast = field_loops(type);
    CAPTURE(cell(type).name);
    const Mesh mesh = box_mesh(type, {1.0, 1.0, 1.0}, 1);
    const std::vector<Law> laws{elastic_law(1.0, 0.3)};
    const Body body{mesh.view(), laws, {}};
    const std::vector<double> u = mesh.coordinates;
    std::vector<double> strain(6 * mesh.element_count() * static_cast<std::size_t>(points_per_element(type)));
    fast.point_fields(body, u, {{}, {}, strain, {}});
    for (std::size_t k = 0; k < strain.size(); ++k)
      CHECK(strain[k] == doctest::Approx(k % 6 < 3 ? 1.0 : 0.0));
    std::vector<double> von_mises(mesh.element_count(), 1.0);
    reference::ElementFields wanted;
    wanted.von_mises = von_mises;
    fast.fields(body, u, wanted);
    for (const double one : von_mises) CHECK(std::abs(one) < 1e-12);
  }
}

namespace {

/// A bent block of two materials; with `means` the softer one uses B-bar or the mixed formulation.
Problem bent_block(ElementType type, bool means) {
  Mesh mesh = box_mesh(type, {2.0, 1.0, 1.0}, 3);
  map_nodes(mesh, [](const Vector3& x) {
    return Vector3{x[0] + 0.1 * std::sin(3.0 * x[1]), x[1] + 0.05 * x[0] * x[2], 1.2 * x[2]};
  });
  Model model;
  model.materials.push_back({everything(), logarithmic_law(0.002)});
  if (means && type == ElementType::hex8) model.materials[0].bbar = true;
  if (means && type != ElementType::hex8) model.materials[0].formulation = MaterialEntry::Formulation::mixed;
  model.materials.push_back({box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), elastic_law(3.0, 0.2)});
  model.boundary.push_back(moved(named("left"), 3));
  return build_problem(mesh, model);
}

std::vector<double> wavy(const Part& part) {
  return nodal_field(part, [](const Vector3& x) {
    return Vector3{0.01 * x[0] * x[1], 0.02 * std::sin(2.0 * x[0]), 0.01 * x[2] * x[0] * x[1]};
  });
}

}  // namespace

TEST_CASE("batched errors are those of the reference loop") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8})
    for (const bool means : {false, true}) {
      CAPTURE(cell(type).name);
      CAPTURE(means);
      const Problem problem = bent_block(type, means);
      const Part part = over_all_ranks(problem);
      const std::vector<double> u = wavy(part), dilatation = corner_dilatation(part, u);
      const BodyState state(u, {}, dilatation);
      const std::size_t elements = part.element_count(), points = points_per_element(type);
      const Patches patches(part);
      for (std::int32_t batch = 0; batch < patches.batches(); ++batch) {
        PatchFits fits = patches.fits(1);
        std::vector<double> trace(elements);
        visit_points(part, state, PointValues::all_but_stress, [&](const PointRun& run) {
          for (std::size_t k = 0; k < run.volume.size(); k += points) {
            const std::size_t e = run.first + k / points;
            const double* strain = &run.strain[6 * k];
            trace[e] = strain[0] + strain[1] + strain[2];
            if (patches.is_in(e, batch))
              patches.add(fits, e, {std::span(run.position).subspan(k, points), {strain}});
          }
        });
        patches.solve(fits);
        const Smoothing of{part, state, patches, fits, 0, trace, {}};
        std::vector<double> found(elements), expected(elements);
        batched_errors(of, batch, found);
        reference_errors(of, batch, expected);
        double largest = 0.0;
        for (const double energy : expected) largest = std::max(largest, energy);
        for (std::size_t e = 0; e < elements; ++e) {
          CHECK(std::abs(found[e] - expected[e]) <= 1e-10 * largest);
          CHECK((patches.is_in(e, batch) || found[e] == 0.0));
        }
      }
    }
}

TEST_CASE("stress and error out of one pass are what they are alone") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    Model model;
    model.materials.push_back({everything(), logarithmic_law(0.002)});
    model.boundary.push_back(moved(named("left"), dimension(type)));
    const Problem problem = build_problem(box_mesh(type), model);
    const Part part = over_all_ranks(problem);
    const std::vector<double> u = wavy(part);
    const Recovered both = recover_and_estimate(part, u);
    CHECK(both.nodal.stress == recover_stress(part, u).stress);
    CHECK(both.error.element == estimate_error(part, u).element);
    CHECK(both.error.relative == estimate_error(part, u).relative);
  }
}
