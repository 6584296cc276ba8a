// SPDX-License-Identifier: BSD-3-Clause
// Regions of similar stiffness, the forces on them, and certificates whose scales are not inflated by large
// forces elsewhere.
#include "contact/regions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <kacanov/part.hpp>
#include <kacanov/reference.hpp>
#include "linear/load_path.hpp"
#include "linear/reference_response.hpp"
#include "problem/vector3.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A heated bar [0,4]×[0,1](×[0,1]) of three segments with these moduli, fixed at its left end.
Model three_lengths(int dim, const std::array<double, 3>& young, double rise, bool mixed = false) {
  Model model;
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr std::array<double, 4> ends{0, 1, 3, 4};
    MaterialEntry entry{box({ends[k], 0, 0}, {ends[k + 1], 1, dim == 3 ? 1.0 : 0.0}),
                        elastic_law(young[k], 0.3)};
    if (mixed && k == 1) entry.formulation = MaterialEntry::Formulation::mixed;
    entry.expansion = 1e-3 * (1.0 + static_cast<double>(k));
    model.materials.push_back(entry);
  }
  model.boundary.push_back(moved(box({}, {0, 1, dim == 3 ? 1.0 : 0.0}), dim));
  BoundaryEntry warm;
  warm.temperature = Temperature{};
  warm.temperature->value = rise;
  model.boundary.push_back(warm);
  return model;
}

Mesh bar(ElementType type) {
  const int dim = cell(type).dim;
  return make_box({{4, 1, 1}, {8, 2, dim == 3 ? 2 : 1}, type});
}

}  // namespace

TEST_CASE("regions: moduli within a factor of ten are one, nodes belong to the stiffest, clusters nest") {
  const auto regions_of = [](const std::array<double, 3>& young) {
    return StiffnessRegions(
        over_all_ranks(build_problem(bar(ElementType::quad4), three_lengths(2, young, 1.0))));
  };
  CHECK(regions_of({1, 1, 1}).count() == 1);
  CHECK(regions_of({1, 3, 5}).count() == 1);
  CHECK(regions_of({1, 1, 1}).clusters().size() == 1);
  const auto ends = regions_of({1, 1e-3, 1});  // two stiff ends, and the middle between them
  CHECK(ends.count() == 3);
  REQUIRE(ends.clusters().size() == 3);
  std::vector<std::size_t> sizes;
  for (const auto& cluster : ends.clusters()) sizes.push_back(cluster.regions.size());
  CHECK(sizes == std::vector<std::size_t>{1, 1, 3});
  const auto& whole = ends.clusters().back();
  CHECK(whole.centre[0] == doctest::Approx(2.0));
  CHECK(whole.radius == doctest::Approx(std::sqrt(17.0) / 2));
  const auto steps = regions_of({1, 0.1, 0.01});
  CHECK(steps.count() == 3);
  sizes.clear();
  for (const auto& cluster : steps.clusters()) sizes.push_back(cluster.regions.size());
  CHECK(sizes == std::vector<std::size_t>{1, 2, 3});
}

TEST_CASE("regions: a node's region is the stiffest of its elements, on every rank that has it") {
  const Part part =
      over_all_ranks(build_problem(bar(ElementType::hex8), three_lengths(3, {1e-4, 1, 1e-2}, 1.0)));
  const StiffnessRegions regions(part);
  for (std::size_t n = 0; n < part.nodes(); ++n) {
    const double x = part.coordinates[3 * n];
    CHECK(regions.bin(regions.of_node(n)) == (x < 0.99 ? 4 : x < 3.01 ? 0 : 2));
  }
}

TEST_CASE("regions: the forces of all regions at a node are R(u) less what temperature presses with") {
  for (const ElementType type :
       {ElementType::tri3, ElementType::quad4, ElementType::tet4, ElementType::tet10, ElementType::hex8})
    for (const bool mixed : {false, true}) {
      const int dim = cell(type).dim;
      if (mixed && dim == 2) continue;
      INFO(cell(type).name << (mixed ? " mixed" : ""));
      Part part = over_all_ranks(build_problem(
          bar(type), three_lengths(dim, {1, 1e-3, 0.03}, 5.0, mixed && type != ElementType::hex8)));
      const StiffnessRegions regions(part);
      REQUIRE(regions.count() == 3);
      const std::vector<double> u = nodal_field(part, [](const Vector3& x) {
        return Vector3{std::sin(3 * x[0] + x[1]), x[0] * x[1] - x[2], std::cos(x[2] + 2 * x[0])};
      });
      const LoadPath path(part);
      const std::vector<double> pressure = path.thermal_pressure(), means = corner_dilatation(part, u);
      std::vector<double> internal(u.size()), expansion(u.size());
      reference_response(part, {u, {}, means}, internal);
      reference::expansion_force(part.body(), pressure, expansion);
      part.node_map.sum(internal, dim);
      part.node_map.sum(expansion, dim);
      const auto forces = regions.interface_forces(u, {pressure, {}}, means);
      CHECK(std::is_sorted(forces.begin(), forces.end(),
                           [](const InterfaceForce& a, const InterfaceForce& b) { return a.node < b.node; }));
      for (auto force = forces.begin(); force != forces.end();) {
        const std::int32_t node = force->node;
        Vector3 sum{};
        int sides = 0;
        for (; force != forces.end() && force->node == node; ++force, ++sides) sum = sum + force->force;
        CHECK(sides == 2);
        for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c) {
          const std::size_t i = static_cast<std::size_t>(node * dim) + c;
          CHECK(sum[c] == doctest::Approx(internal[i] - expansion[i]).epsilon(1e-11).scale(1.0));
        }
      }
      const std::size_t layer = dim == 2 ? 3 : type == ElementType::tet10 ? 25 : 9;
      CHECK(part.node_map.sum_all(static_cast<double>(forces.size())) ==
            2.0 * 2.0 * static_cast<double>(layer));
    }
}

TEST_CASE("regions: temperature alone presses with the load that the problem has of it") {
  for (const ElementType type :
       {ElementType::tri3, ElementType::quad4, ElementType::tet4, ElementType::tet10, ElementType::hex8})
    for (const PlaneState plane : {PlaneState::strain, PlaneState::stress, PlaneState::axisymmetric}) {
      const int dim = cell(type).dim;
      if (dim == 3 && plane != PlaneState::strain) continue;
      INFO(cell(type).name);
      Model model = three_lengths(dim, {1, 0.5, 2}, 5.0);
      model.boundary[1].temperature->gradient = {2.0, -1.0, dim == 3 ? 3.0 : 0.0};
      Mesh mesh = bar(type);
      map_nodes(mesh, [](const Vector3& x) {
        return Vector3{x[0], x[1] + 0.2 * x[1] * (1 - x[1]) * std::sin(x[0] + x[2]), x[2]};
      });
      mesh.plane = plane;
      Part part = over_all_ranks(build_problem(std::move(mesh), model));
      std::vector<double> load(part.unknowns(), 0.0), expansion(part.unknowns());
      part.add_load(load);
      const double energy =
          reference::expansion_force(part.body(), LoadPath(part).thermal_pressure(), expansion);
      part.node_map.sum(expansion, dim);
      CHECK((part.element_count() == 0 || energy > 0.0));
      for (std::size_t i = 0; i < load.size(); ++i)
        CHECK(expansion[i] == doctest::Approx(load[i]).epsilon(1e-11).scale(1e-3));
    }
}

namespace {

/// Force and status of a run of a bar whose softer free end is pressed on a plane by `overlap`.
struct Pressed {
  Status status;
  double force;
  std::uint64_t applications;
};

struct Inflated {
  double ratio = 1.0;       ///< modulus of the free half relative to the fixed half
  double rise = 0.0;        ///< of the temperature
  double moved = 0.0;       ///< displacement of the fixed end
  double cancelling = 0.0;  ///< stress of two loads on opposite sides
  double weight = 0.0;      ///< of the fixed half
};

Pressed press(const Inflated& by, double overlap, double accuracy) {
  Model model;
  MaterialEntry held{everything(), elastic_law(1.0, 0.3)},
      end{box({2, 0, 0}, {4, 1, 0}), elastic_law(by.ratio, 0.4)};
  held.expansion = 1e-5, end.expansion = 1e-4;
  model.materials = {held, end};
  model.boundary.push_back(moved(box({}, {0, 1, 0}), 2, {by.moved, 0, 0}));
  BoundaryEntry warm;
  warm.temperature = Temperature{};
  warm.temperature->value = by.rise;
  model.boundary.push_back(warm);
  model.boundary.push_back(traction(box({0, 1, 0}, {4, 1, 0}), {0, by.cancelling, 0}));
  model.boundary.push_back(traction(box({0, 0, 0}, {4, 0, 0}), {0, -by.cancelling, 0}));
  BoundaryEntry weight;
  weight.on = box({0, 0, 0}, {2, 1, 0});
  weight.body_force = Vector3{0, -by.weight, 0};
  model.boundary.push_back(weight);
  // The position of the free end without the obstacle, computed from the same problem.
  const Mesh mesh = make_box({{4, 1, 1}, {16, 4, 1}, ElementType::quad4});
  model.solver.tolerance = 1e-12;
  model.probes.push_back({4, 0.5, 0});
  const double free = run_alone(mesh, model).probe()[0];
  model.contact.push_back(on_plane(box({4, 0, 0}, {4, 1, 0}), {4.0 + free - overlap, 0, 0}, {-1, 0, 0}));
  model.solver.tolerance = accuracy;
  const Run run = run_alone(mesh, model);
  return {run.result().status, length(run.result().contact_force), run.result().operator_applications};
}

}  // namespace

TEST_CASE("a contact force that is certified is right, however much larger all else is") {
  const std::array<Inflated, 8> all{
      Inflated{.ratio = 1e-3, .rise = 100},        Inflated{.ratio = 1e-6, .rise = 100},
      Inflated{.ratio = 1e-5, .rise = -50},        Inflated{.ratio = 1e-4, .moved = 1e-4},
      Inflated{.ratio = 1e-3, .cancelling = 1e-4}, Inflated{.ratio = 1.0, .cancelling = 1e-3},
      Inflated{.ratio = 1e-4, .weight = 1e-3},     Inflated{.ratio = 1.0, .rise = 100, .weight = 1e-4}};
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const double overlap : {1e-3, 1e-5}) {
      INFO(k << ", " << overlap);
      const Pressed usual = press(all[k], overlap, 1e-6), exact = press(all[k], overlap, 1e-11);
      CHECK(usual.status == Status::converged);
      REQUIRE(exact.force > 0.0);
      CHECK(std::abs(usual.force - exact.force) <= 1e-3 * exact.force);
    }
}

TEST_CASE("pieces are judged one by one: what is lacking on a small one is not lost beside a large one") {
  // Two bars, one pressed a million times as hard; the other's contact force is accurate to its own digits.
  Model model;
  Mesh mesh = make_box({{4, 1, 1}, {8, 2, 1}, ElementType::quad4});
  const std::size_t nodes = mesh.node_count(), cells = mesh.elements.size();
  for (std::size_t n = 0; n < nodes; ++n) {
    mesh.coordinates.push_back(mesh.coordinates[2 * n]);
    mesh.coordinates.push_back(mesh.coordinates[2 * n + 1] + 2.0);
  }
  for (std::size_t k = 0; k < cells; ++k)
    mesh.elements.push_back(mesh.elements[k] + static_cast<std::int32_t>(nodes));
  find_boundary(mesh);
  model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
  model.boundary.push_back(moved(box({}, {0, 3, 0}), 2));
  const double strong = 1e-2, weak = 1e-8;
  model.contact.push_back(on_plane(box({4, 0, 0}, {4, 1, 0}), {4.0 - strong, 0, 0}, {-1, 0, 0}));
  model.contact.push_back(on_plane(box({4, 2, 0}, {4, 3, 0}), {4.0 - weak, 0, 0}, {-1, 0, 0}));
  const Run run = run_alone(mesh, model);
  REQUIRE(run.result().status == Status::converged);
  // The same linear body: forces are proportional to indentations.
  const double expected = length(run.result().contact[0].total.force) * weak / strong;
  CHECK(length(run.result().contact[1].total.force) == doctest::Approx(expected).epsilon(1e-4));
}
