// SPDX-License-Identifier: BSD-3-Clause
// Problems with closed-form solutions, and the effectivity of the error estimate on them.
#include <doctest/doctest.h>

#include <algorithm>

#include <kacanov/discretisation.hpp>
#include <kacanov/element_fields.hpp>
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

/// Returns the strain under given principal stresses; in plane strain the third stress is unknown and ε_zz =
/// 0.
Vector3 strain_under(const Law& law, int dim, Vector3 stress) {
  const auto principal = [&](const Vector3& t) {
    const double mean = (t[0] + t[1] + t[2]) / 3.0;
    const Vector3 d{t[0] - mean, t[1] - mean, t[2] - mean};
    const double s = length(d);
    // ‖dev τ‖ = 2 g(x) x is monotone in x.
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 100; ++i) {
      const double x = 0.5 * (low + high);
      (2 * law.secant(x) * x < s ? low : high) = x;
    }
    const double factor = s > 0.0 ? high / s : 0.0;
    const double third = mean / (3 * law.bulk);
    return Vector3{third + factor * d[0], third + factor * d[1], third + factor * d[2]};
  };
  if (dim == 3) return principal(stress);
  double low = -10.0, high = 10.0;
  for (int i = 0; i < 100; ++i) {
    stress[2] = 0.5 * (low + high);
    (principal(stress)[2] < 0.0 ? low : high) = stress[2];
  }
  return principal(stress);
}

/// Returns the largest distance between nodal displacements and an exact field.
double largest_error(const Run& run, const std::function<Vector3(const Vector3&)>& exact) {
  const std::size_t dim = run.part.dim();
  double worst = 0.0;
  for (std::size_t i = 0; i < run.part.nodes(); ++i) {
    const double* x = &run.part.coordinates[i * dim];
    const double* u = &run.solution.displacement[i * dim];
    worst = std::max(
        worst, distance({u[0], u[1], dim == 3 ? u[2] : 0.0}, exact({x[0], x[1], dim == 3 ? x[2] : 0.0})));
  }
  return worst;
}

const std::vector<ElementType> straight = {ElementType::tri3, ElementType::tet4, ElementType::hex8};

}  // namespace

TEST_CASE("contact patch: a loaded block on a frictionless plane strains evenly") {
  const double p = 0.02;
  for (const ElementType type : straight)
    for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.01), elastic_law(1.0, 0.45)}) {
      const int dim = dimension(type);
      CAPTURE(dim);
      const std::size_t up = dim - 1;
      Vector3 normal{}, stress{};
      normal[up] = 1.0;
      stress[up] = -p;
      Model model;
      model.materials.push_back({everything(), law});
      model.boundary.push_back(roller(named("left"), 0));
      if (dim == 3) model.boundary.push_back(roller(named("front"), 1));
      model.boundary.push_back(pressure(named("top"), p));
      model.contact.push_back(on_plane(named("bottom"), {}, normal));
      model.solver.tolerance = 1e-9;
      const Run run = run_alone(box_mesh(type, {1.0, 1.0, 1.5}), model);
      CHECK(run.result().status == Status::converged);
      const Vector3 strain = strain_under(law, dim, stress);
      const double size = std::abs(strain[up]);
      CHECK(largest_error(run, [&](const Vector3& x) {
              return Vector3{strain[0] * x[0], strain[1] * x[1], dim == 3 ? strain[2] * x[2] : 0.0};
            }) < 1e-7 * size);
      for (const double lambda : run.solution.pressure) CHECK(lambda == doctest::Approx(p).epsilon(1e-6));
      for (const double gap : run.solution.gap) CHECK(std::abs(gap) < 1e-8 * size);
      CHECK(run.result().active_nodes == run.result().contact_nodes);
      CHECK(run.result().slip_nodes == 0);
    }
}

TEST_CASE("contact patch, turned: a block held by nothing but three planes") {
  const Vector3 press{0.011, 0.017, 0.02};
  for (const ElementType type : straight)
    for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.005)}) {
      const int dim = dimension(type);
      CAPTURE(dim);
      const Rotation turn(dim, 0.7);
      Mesh mesh = box_mesh(type, {1.0, 1.0, 1.5});
      map_nodes(mesh, turn);
      Model model;
      model.materials.push_back({everything(), law});
      const std::array<std::pair<const char*, const char*>, 3> sides =
          dim == 2
              ? std::array<std::pair<const char*, const char*>, 3>{{{"left", "right"}, {"bottom", "top"}}}
              : std::array<std::pair<const char*, const char*>, 3>{
                    {{"left", "right"}, {"front", "back"}, {"bottom", "top"}}};
      Vector3 stress{};
      for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c) {
        Vector3 normal{};
        normal[c] = 1.0;
        stress[c] = -press[c];
        model.boundary.push_back(pressure(named(sides[c].second), press[c]));
        model.contact.push_back(on_plane(named(sides[c].first), {}, turn(normal)));
      }
      model.solver.tolerance = 1e-9;
      const Run run = run_alone(std::move(mesh), model);
      CHECK(run.problem.loose_modes == (dim == 2 ? 3 : 6));
      CHECK(run.result().status == Status::converged);
      const Vector3 strain = strain_under(law, dim, stress);
      CHECK(largest_error(run, [&](const Vector3& x) {
              // Rotate back to the axes of the block, strain, rotate again.
              Vector3 y{};
              for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) y[i] += turn.row[j][i] * x[j];
              return turn({strain[0] * y[0], strain[1] * y[1], dim == 3 ? strain[2] * y[2] : 0.0});
            }) < 1e-6 * length(strain));
      for (std::size_t i = 0; i < run.part.contact.size(); ++i)
        CHECK(run.solution.pressure[i] == doctest::Approx(press[run.part.contact[i].entry]).epsilon(1e-5));
    }
}

TEST_CASE("confined block: gap, indentation and prescribed displacement in one dimension") {
  // The sides are on rollers, so that only the height changes: pressure = (k0 + 4μ/3) × closing / height.
  const Law law = elastic_law(2.0, 0.25);
  const double stiffness = law.bulk + 4.0 / 3.0 * law.shear;
  struct Case {
    double gap, drop, expected_closing;
  };
  for (const ElementType type : straight)
    for (const Case& each : {Case{0.005, 0.02, 0.015}, Case{-0.01, 0.0, 0.01}, Case{-0.01, 0.005, 0.015}}) {
      const int dim = dimension(type);
      const double gap = each.gap, drop = each.drop, closing = each.expected_closing;
      CAPTURE(dim);
      CAPTURE(gap);
      CAPTURE(drop);
      const std::size_t up = dim - 1;
      const double height = dim == 2 ? 1.0 : 0.5;
      Model model;
      model.materials.push_back({everything(), law});
      for (const char* side : {"left", "right"}) model.boundary.push_back(roller(named(side), 0));
      if (dim == 3)
        for (const char* side : {"front", "back"}) model.boundary.push_back(roller(named(side), 1));
      Vector3 down{};
      down[up] = -drop;
      model.boundary.push_back(moved(named("top"), dim, down));
      ContactEntry contact;
      contact.on = named("bottom");
      contact.obstacle = ConstantGap{gap};
      model.contact.push_back(contact);
      model.solver.tolerance = 1e-9;
      const Run run = run_alone(box_mesh(type), model);
      CHECK(run.result().status == Status::converged);
      const double expected = stiffness * closing / height;
      CHECK(run.result().max_contact_pressure == doctest::Approx(expected).epsilon(1e-7));
      for (const double lambda : run.solution.pressure)
        CHECK(lambda == doctest::Approx(expected).epsilon(1e-6));
      for (const double open : run.solution.gap)
        CHECK(open == doctest::Approx(std::max(0.0, gap - drop)).epsilon(1e-7).scale(0.01));
      CHECK(run.result().active_nodes == (closing > 0.0 ? run.result().contact_nodes : 0));
    }
}

TEST_CASE("a block that does not reach the obstacle") {
  for (const ElementType type : straight) {
    const int dim = dimension(type);
    const std::size_t up = dim - 1;
    Vector3 down{}, weight{};
    down[up] = -0.02;
    weight[up] = -0.001;
    Model model = elastic_model();
    model.boundary.push_back(moved(named("top"), dim, down));
    model.boundary.push_back(body_force(everything(), weight));
    ContactEntry contact;
    contact.on = named("bottom");
    contact.obstacle = ConstantGap{0.03};
    model.contact.push_back(contact);
    const Run run = run_alone(box_mesh(type), model);
    CHECK(run.result().status == Status::converged);
    CHECK(run.result().active_nodes == 0);
    CHECK(run.result().max_contact_pressure == 0.0);
    for (const double open : run.solution.gap) {
      CHECK(open > 0.005);
      CHECK(open < 0.01);
    }
  }
}

TEST_CASE("block under its own weight: the plane carries it all") {
  for (const ElementType type : element_types()) {
    const int dim = dimension(type);
    CAPTURE(static_cast<int>(type));
    const std::size_t up = dim - 1;
    Vector3 weight{}, normal{};
    weight[up] = -0.01;
    normal[up] = 1.0;
    Model model;
    model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
    model.boundary.push_back(roller(named("left"), 0));
    if (dim == 3) model.boundary.push_back(roller(named("front"), 1));
    model.boundary.push_back(body_force(everything(), weight));
    model.contact.push_back(on_plane(named("bottom"), {}, normal));
    model.solver.tolerance = 1e-8;
    const Run run = run_alone(box_mesh(type), model);
    CHECK(run.result().status == Status::converged);
    const double total = 0.01 * (dim == 2 ? 2.0 : 1.0);
    CHECK(run.result().contact_force[up] == doctest::Approx(total).epsilon(1e-7));
    CHECK(std::abs(run.result().contact_force[0]) < 1e-12);
    CHECK(length(run.result().friction_force) == 0.0);
  }
}

TEST_CASE("no contact: even tension, and a stretched bar") {
  for (const ElementType type : element_types())
    for (const bool prescribed : {false, true}) {
      const int dim = dimension(type);
      CAPTURE(static_cast<int>(type));
      CAPTURE(prescribed);
      const Law law = logarithmic_law(0.01);
      Model model;
      model.materials.push_back({everything(), law});
      model.boundary.push_back(roller(named("left"), 0));
      model.boundary.push_back(roller(named("bottom"), dim - 1));
      if (dim == 3) model.boundary.push_back(roller(named("front"), 1));
      const Vector3 strain = strain_under(law, dim, {0.02, 0.0, 0.0});
      if (prescribed)
        model.boundary.push_back(displacement(named("right"), {2.0 * strain[0], std::nullopt, std::nullopt}));
      else
        model.boundary.push_back(traction(named("right"), {0.02, 0, 0}));
      model.solver.tolerance = 1e-9;
      const Run run = run_alone(box_mesh(type), model);
      CHECK(run.result().status == Status::converged);
      CHECK(largest_error(run, [&](const Vector3& x) {
              return Vector3{strain[0] * x[0], strain[1] * x[1], dim == 3 ? strain[2] * x[2] : 0.0};
            }) < 1e-7 * strain[0]);
      CHECK(run.result().plastic_elements == run.result().elements);
      CHECK(run.result().contact_nodes == 0);
      visit_element_fields(run.part, run.solution.displacement, [](const ElementRun& fields) {
        for (std::size_t e = 0; e < fields.von_mises.size(); ++e)
          CHECK(fields.stress[6 * e] == doctest::Approx(0.02).epsilon(1e-6));
      });
    }
}

namespace {

Run bent(ElementType type, int cells, const Law& law) {
  const int dim = dimension(type);
  return run_alone(make_box({{2.0, 1.0, 1.0}, {2 * cells, cells, dim == 3 ? cells : 1}, type}),
                   bent_model(dim, law));
}

double stored_energy(const Run& run) { return reference::energy(run.part.body(), run.solution.displacement); }

}  // namespace

TEST_CASE("the estimate is the error, within a half and twice, elastic and beyond yield") {
  for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.002)})
    for (const int dim : {2, 3}) {
      // Richardson extrapolation of the energies of finer meshes of the best element.
      const ElementType best = dim == 2 ? ElementType::quad4 : ElementType::tet10;
      const int fine = dim == 2 ? 64 : 8;
      const double half = stored_energy(bent(best, fine / 2, law)),
                   whole = stored_energy(bent(best, fine, law));
      const double exact = whole - (half - whole) / 2.0;
      for (const ElementType type : element_types()) {
        if (dimension(type) != dim) continue;
        CAPTURE(cell(type).name);
        CAPTURE(law.linear());
        const Run run = bent(type, cell(type).order == 1 ? 8 : 4, law);
        REQUIRE(run.result().status == Status::converged);
        const DiscretisationError error = estimate_error(run.part, run.solution);
        const double effectivity = std::sqrt(error.energy / (stored_energy(run) - exact));
        INFO("effectivity " << effectivity << " at " << error.relative);
        CHECK(effectivity > 0.5);
        CHECK(effectivity < 2.0);
      }
    }
}
