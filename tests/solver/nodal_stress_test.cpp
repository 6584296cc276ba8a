// SPDX-License-Identifier: BSD-3-Clause
// Recovered nodal stress: exact for the polynomials of the fit, accurate at a notch, independent of the
// number of ranks.
#include <kacanov/discretisation.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "recovery/spr_patches.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

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
