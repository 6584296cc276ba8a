// SPDX-License-Identifier: BSD-3-Clause
// Problems with an answer in closed form, or from an ordinary differential equation.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include <kacanov/element_fields.hpp>
#include "radial.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Strain under given principal stresses (three of them, the last one unknown in plane strain, where ε_zz =
/// 0).
Vector3 strain_under(const Law& law, int dim, Vector3 stress) {
  const auto principal = [&](const Vector3& t) {
    const double mean = (t[0] + t[1] + t[2]) / 3.0;
    const Vector3 d{t[0] - mean, t[1] - mean, t[2] - mean};
    const double s = length(d);
    // ‖dev τ‖ = 2 g(x) x grows with x.
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

/// Greatest distance of the nodal displacements from a field.
double largest_error(const Run& run, const std::function<Vector3(const Vector3&)>& exact) {
  const auto dim = static_cast<std::size_t>(run.part.dim());
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
      const auto up = static_cast<std::size_t>(dim - 1);
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
              // Back to the axes of the block, strained, and turned again.
              Vector3 y{};
              for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) y[i] += turn.row[j][i] * x[j];
              return turn({strain[0] * y[0], strain[1] * y[1], dim == 3 ? strain[2] * y[2] : 0.0});
            }) < 1e-6 * length(strain));
      for (std::size_t i = 0; i < run.part.contact.size(); ++i)
        CHECK(run.solution.pressure[i] ==
              doctest::Approx(press[static_cast<std::size_t>(run.part.contact[i].entry)]).epsilon(1e-5));
    }
}

TEST_CASE("confined block: gap, indentation and prescribed displacement in one dimension") {
  // Sides roll, so that the only strain is along the height: pressure = (k0 + 4μ/3) × closing / height.
  const Law law = elastic_law(2.0, 0.25);
  const double stiffness = law.bulk + 4.0 / 3.0 * law.shear;
  struct Case {
    double gap, drop, expected_closing;
  };
  for (const ElementType type : straight)
    for (const auto& [gap, drop, closing] :
         {Case{0.005, 0.02, 0.015}, Case{-0.01, 0.0, 0.01}, Case{-0.01, 0.005, 0.015}}) {
      const int dim = dimension(type);
      CAPTURE(dim);
      CAPTURE(gap);
      CAPTURE(drop);
      const auto up = static_cast<std::size_t>(dim - 1);
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
    const auto up = static_cast<std::size_t>(dim - 1);
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
  for (const ElementType type :
       {ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    const int dim = dimension(type);
    CAPTURE(static_cast<int>(type));
    const auto up = static_cast<std::size_t>(dim - 1);
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
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8})
    for (const bool prescribed : {false, true}) {
      const int dim = dimension(type);
      CAPTURE(static_cast<int>(type));
      CAPTURE(prescribed);
      const Law law = logarithmic_law(0.01);
      Model model;
      model.materials.push_back({everything(), law});
      model.boundary.push_back(roller(named("left"), 0));
      model.boundary.push_back(roller(named("bottom"), static_cast<std::size_t>(dim - 1)));
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

constexpr double inner = 1.0, outer = 2.0;

/// The facets all of whose nodes satisfy a condition, as a named part.
void name_facets(Mesh& mesh, const std::string& name, const std::function<bool(const Vector3&)>& here) {
  const auto dim = static_cast<std::size_t>(mesh.dim());
  Group group{name, mesh.dim() - 1, {}};
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const auto nodes = mesh.facet(f);
    if (std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t n) {
          const double* x = &mesh.coordinates[static_cast<std::size_t>(n) * dim];
          return here({x[0], x[1], dim == 3 ? x[2] : 0.0});
        }))
      group.members.push_back(static_cast<std::int32_t>(f));
  }
  mesh.groups.push_back(group);
}

/// A quarter of a thick cylinder, an octant of a thick sphere: the shell of cubes with ½ ≤ max x ≤ 1 blown up
/// to a round one, n cells through the wall.
Mesh round_shell(int dim, int n) {
  BoxSpec spec;
  spec.cells = {2 * n, 2 * n, 2 * n};
  spec.type = dim == 2 ? ElementType::tri3 : ElementType::tet4;
  const Mesh cube = make_box(spec);
  const auto d = static_cast<std::size_t>(dim);
  const auto npe = static_cast<std::size_t>(nodes_per_element(cube.type));
  Mesh mesh;
  mesh.type = cube.type;
  std::map<std::int32_t, std::int32_t> kept;
  for (std::size_t e = 0; e < cube.element_count(); ++e) {
    const auto nodes = std::span(cube.elements).subspan(e * npe, npe);
    double mean = 0.0;  // of the largest coordinate: below ½ only inside the hole
    for (const auto node : nodes) {
      const double* x = &cube.coordinates[static_cast<std::size_t>(node) * d];
      mean += *std::max_element(x, x + d) / static_cast<double>(npe);
    }
    if (mean < 0.5) continue;
    for (const auto node : nodes) {
      const auto [place, fresh] = kept.try_emplace(node, static_cast<std::int32_t>(kept.size()));
      mesh.elements.push_back(place->second);
      if (!fresh) continue;
      const double* x = &cube.coordinates[static_cast<std::size_t>(node) * d];
      mesh.coordinates.insert(mesh.coordinates.end(), x, x + d);
    }
  }
  map_nodes(mesh, [&](Vector3 x) {
    const double level = std::max({x[0], x[1], x[2]}), r = inner + (outer - inner) * (2 * level - 1);
    for (double& v : x) v = std::tan(0.25 * M_PI * v / level);  // even angles
    const double size = length(x);
    return Vector3{r * x[0] / size, r * x[1] / size, r * x[2] / size};
  });
  find_boundary(mesh);
  check_mesh(mesh);
  name_facets(mesh, "inside", [](const Vector3& x) { return std::abs(length(x) - inner) < 1e-9; });
  for (std::size_t c = 0; c < d; ++c)
    name_facets(mesh, std::string("plane") + "xyz"[c],
                [c](const Vector3& x) { return std::abs(x[c]) < 1e-9; });
  return mesh;
}

/// L² error of the displacement relative to its norm, by the edge-midpoint (2D) or the four-point (3D) rule.
double displacement_error(const Run& run, const RadialSolution& exact) {
  const Part& part = run.part;
  const auto dim = static_cast<std::size_t>(part.dim()), npe = dim + 1;
  std::vector<double> volume(part.element_count());
  reference::volumes(part.body(), volume);
  const double far = dim == 2 ? 0.5 : 0.1381966011250105, near = dim == 2 ? 0.0 : 0.5854101966249685;
  double error = 0.0, size = 0.0;
  for (std::size_t e = 0; e < volume.size(); ++e)
    for (std::size_t q = 0; q < npe; ++q) {
      Vector3 x{}, u{};
      for (std::size_t a = 0; a < npe; ++a) {
        const auto node = static_cast<std::size_t>(part.elements[e * npe + a]);
        for (std::size_t c = 0; c < dim; ++c) {
          x[c] += (a == q ? near : far) * part.coordinates[node * dim + c];
          u[c] += (a == q ? near : far) * run.solution.displacement[node * dim + c];
        }
      }
      const double r = length(x), radial = exact(r);
      const double weight = volume[e] / static_cast<double>(npe);
      error += weight * std::pow(distance(u, {radial * x[0] / r, radial * x[1] / r, radial * x[2] / r}), 2);
      size += weight * radial * radial;
    }
  return std::sqrt(error / size);
}

void check_order(int dim, const std::vector<int>& cells, double pressure_inside, double finest_error) {
  CAPTURE(dim);
  for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.01)}) {
    const RadialSolution exact(law, dim - 1, inner, outer, pressure_inside);
    if (law.kind != Law::Kind::linear) CHECK(exact.largest_dev_strain() > 3 * law.x0);
    std::vector<double> errors;
    for (const int n : cells) {
      Model model;
      model.materials.push_back({everything(), law});
      for (int c = 0; c < dim; ++c)
        model.boundary.push_back(roller(named(std::string("plane") + "xyz"[c]), static_cast<std::size_t>(c)));
      model.boundary.push_back(pressure(named("inside"), pressure_inside));
      model.solver.tolerance = 1e-8;
      const Run run = run_alone(round_shell(dim, n), model);
      CHECK(run.result().status == Status::converged);
      errors.push_back(displacement_error(run, exact));
    }
    const std::size_t last = errors.size() - 1;
    CAPTURE(errors[last - 1]);
    CAPTURE(errors[last]);
    CHECK(std::log2(errors[last - 1] / errors[last]) > 1.7);
    CHECK(errors[last] < finest_error);
  }
}

}  // namespace

TEST_CASE("the radial solution: Lamé's formulas and the incompressible limit") {
  const Law linear = elastic_law(1.0, 0.3);
  const double lame = linear.bulk - 2.0 / 3.0 * linear.shear, p = 0.01;
  // u = A r + C / r^m with τ_r(a) = −p, τ_r(b) = 0.
  for (const int m : {1, 2}) {
    const double ratio = std::pow(inner / outer, m + 1),
                 c = p * std::pow(inner, m + 1) / (2 * linear.shear * m * (1 - ratio));
    const double a = p * ratio / ((1 - ratio) * ((m + 1) * lame + 2 * linear.shear));
    const RadialSolution exact(linear, m, inner, outer, p);
    for (const double r : {inner, 1.3, outer})
      CHECK(exact(r) == doctest::Approx(a * r + c / std::pow(r, m)).epsilon(1e-6));
  }
  // Nearly incompressible: u = C/r^m and p = factor [H(x_a) − H(x_b)], H(x) = ∫ g ds.
  const Law law = logarithmic_law(0.01, 1.0, 0.49999);
  const auto h = [&](double x) {
    if (x <= law.x0) return law.shear * x;
    const double l = std::log(x / law.x0);
    return law.shear * law.x0 * (1 + l + 0.5 * l * l);
  };
  for (const int m : {1, 2}) {
    const double strain = m == 1 ? std::sqrt(2.0) : std::sqrt(6.0),
                 factor = m == 1 ? std::sqrt(2.0) : 4 / std::sqrt(6.0);
    const double c = 0.03;
    const double load = factor * (h(strain * c) - h(strain * c / std::pow(outer, m + 1)));
    const RadialSolution exact(law, m, inner, outer, load);
    CHECK(exact(inner) == doctest::Approx(c).epsilon(2e-3));
    CHECK(exact(outer) == doctest::Approx(c / std::pow(outer, m)).epsilon(2e-3));
  }
}

TEST_CASE("thick cylinder under pressure: second order against the radial equation") {
  check_order(2, {16, 32}, 0.02, 3e-3);
}

TEST_CASE("thick sphere under pressure: second order against the radial equation") {
  check_order(3, {5, 10}, 0.02, 3e-2);
}
