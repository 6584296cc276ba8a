// SPDX-License-Identifier: BSD-3-Clause
// Coulomb friction against statics and beam theory: a block on an incline, a wedge between two planes, a ring
// pressed on its foot or between planes; rotated, in m and mm, on any number of ranks.
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A rotation and a unit of length; stresses do not change.
struct Frame {
  Rotation turn;
  double unit;
  Vector3 place(const Vector3& x) const { return turn({unit * x[0], unit * x[1], unit * x[2]}); }
};

double product(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A ring of quadrilaterals with mean radius 1 and thickness `thick`; groups for the upper half of its outer
/// side, the lower half, and the lowest facet.
Mesh ring(int round, int across, double thick, const Frame& frame) {
  Mesh mesh;
  mesh.type = ElementType::quad4;
  std::vector<double> height;
  for (int k = 0; k <= across; ++k)
    for (int i = 0; i < round; ++i) {
      // Nodes at half steps, so that none lies exactly between top and side.
      const double angle = 2 * std::numbers::pi * (i + 0.5) / round, r = 1 + thick * (1.0 * k / across - 0.5);
      const Vector3 x = frame.place({r * std::cos(angle), r * std::sin(angle), 0});
      mesh.coordinates.insert(mesh.coordinates.end(), {x[0], x[1]});
      height.push_back(r * std::sin(angle));
    }
  for (int k = 0; k < across; ++k)
    for (int i = 0; i < round; ++i) {
      const int next = (i + 1) % round;
      for (const int node : {k * round + i, (k + 1) * round + i, (k + 1) * round + next, k * round + next})
        mesh.elements.push_back(node);
    }
  find_boundary(mesh);
  Group upper{"upper", 1, {}}, lower{"lower", 1, {}}, foot{"foot", 1, {}};
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(mesh.facet_count()); ++f) {
    const auto facet = mesh.facet(static_cast<std::size_t>(f));
    if (facet[0] < across * round) continue;
    const double mean =
        0.5 * (height[static_cast<std::size_t>(facet[0])] + height[static_cast<std::size_t>(facet[1])]);
    (mean > 0.0 ? upper : lower).members.push_back(f);
    if (mean < (1 + 0.5 * thick) * -std::cos(1.2 * std::numbers::pi / round)) foot.members.push_back(f);
  }
  mesh.groups = {upper, lower, foot};
  check_mesh(mesh);
  return mesh;
}

}  // namespace

TEST_CASE("a block on an incline sticks just below its friction angle, with the forces of statics") {
  for (const ElementType type : {ElementType::tet10, ElementType::hex8})
    for (const double unit : {1.0, 1e-3}) {
      CAPTURE(static_cast<int>(type));
      CAPTURE(unit);
      const Frame frame{Rotation(3, 0.9), unit};
      const double coulomb = 0.4, angle = std::atan(0.999 * coulomb), weight = 1e-3 / unit;
      Model model = elastic_model();
      model.boundary.push_back(
          body_force(everything(), frame.turn({weight * std::sin(angle), 0, -weight * std::cos(angle)})));
      model.contact.push_back(on_plane(named("bottom"), {}, frame.turn({0, 0, 1}), 0.0, coulomb));
      Mesh mesh = box_mesh(type, {2.0, 1.0, 0.5});
      map_nodes(mesh, [&](const Vector3& x) { return frame.place(x); });
      Part part;
      const Solution solution = solve_everywhere(build_problem(mesh, model), model, part);
      CHECK(solution.result.status == Status::converged);
      const double all = weight * unit * unit * unit;
      CHECK(product(solution.result.contact_force, frame.turn({0, 0, 1})) ==
            doctest::Approx(all * std::cos(angle)).epsilon(1e-5));
      CHECK(product(solution.result.friction_force, frame.turn({1, 0, 0})) ==
            doctest::Approx(-all * std::sin(angle)).epsilon(1e-5));
    }
}

TEST_CASE("a wedge pressed between two planes: friction that slides on both takes its share of the force") {
  const double alpha = 0.5;
  for (const ElementType type : {ElementType::quad4, ElementType::tet10})
    for (const double coulomb : {0.0, 0.1}) {
      const int dim = dimension(type);
      CAPTURE(dim);
      CAPTURE(coulomb);
      const double unit = dim == 2 ? 1.0 : 1e-3;
      const Frame frame{Rotation(dim, 1.3), unit};
      const auto up = static_cast<std::size_t>(dim - 1);
      Mesh mesh = make_box({{2, 1, 1}, {6, dim == 2 ? 4 : 2, 3}, type});
      map_nodes(mesh, [&](const Vector3& x) {
        Vector3 y = x;
        y[0] = (x[0] - 1) * (0.5 + x[up] * std::tan(alpha));
        return frame.place(y);
      });
      // Normals of the planes that point into the body, and points on the planes.
      Vector3 left{}, right{}, above{}, load{};
      left[0] = std::cos(alpha), right[0] = -std::cos(alpha), left[up] = right[up] = std::sin(alpha);
      above[up] = 1.0;
      load[up] = -1e-3;
      Model model = elastic_model();
      if (dim == 3) {  // with ν = 0, which makes 3D plane strain
        model.materials[0].law = elastic_law(1.0, 0.0);
      }
      model.boundary.push_back(traction(named("top"), frame.turn(load)));
      model.contact.push_back(
          on_plane(named("left"), frame.place({-0.5, 0, 0}), frame.turn(left), 0.0, coulomb));
      model.contact.push_back(
          on_plane(named("right"), frame.place({0.5, 0, 0}), frame.turn(right), 0.0, coulomb));
      if (dim == 3 && coulomb == 0.0) continue;  // nothing would fix it along the groove
      Part part;
      const Solution solution = solve_everywhere(build_problem(mesh, model), model, part);
      CHECK(solution.result.status == Status::converged);
      const double normal = product(solution.result.contact_force, frame.turn(above)),
                   friction = product(solution.result.friction_force, frame.turn(above));
      const double width = 2 * (0.5 + std::tan(alpha)),
                   force = 1e-3 * width * (dim == 3 ? unit * unit : unit);
      CHECK(normal + friction == doctest::Approx(force).epsilon(1e-5));
      // All closed points slide inwards: N = F / (2 (sin α + μ cos α)).
      CHECK(solution.result.slip_nodes >= (coulomb > 0.0 ? solution.result.active_nodes : 0));
      CHECK(normal ==
            doctest::Approx(force / (1 + coulomb / std::tan(alpha))).epsilon(dim == 2 ? 1e-4 : 1e-2));
    }
}

/// Change of the diameter per force of a thin ring by bending, stretching and shear (Timoshenko).
double ring_compliance(double thick, double poisson) {
  const double modulus = 1.0 / (1 - poisson * poisson), inertia = thick * thick * thick / 12,
               shear = 1.0 / (2 * (1 + poisson)), pi = std::numbers::pi;
  return (pi / 4 - 2 / pi) / (modulus * inertia) + pi / 4 / (modulus * thick) +
         1.2 * pi / 4 / (shear * thick);
}

TEST_CASE("a ring pressed between two planes, which alone hold it, though all that touches slides") {
  const double thick = 0.1, press = 5e-4, top = 1 + thick / 2 - press;
  const Frame frame{Rotation(2, 0.4), 1.0};
  Model model;
  model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
  for (const double side : {1.0, -1.0})
    model.contact.push_back(on_plane(named(side > 0.0 ? "upper" : "lower"), frame.place({0, side * top, 0}),
                                     frame.turn({0, -side, 0}), 0.0, 0.3));
  Part part;
  const Solution solution = solve_everywhere(build_problem(ring(140, 4, thick, frame), model), model, part);
  CAPTURE(solution.result.message);
  CHECK(solution.result.status == Status::converged);
  if (solution.result.ranks == 1) CHECK(solution.result.cg_iterations <= 1000);
  double force = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i)
    if (part.contact[i].entry == 0) force += part.contact[i].mass * solution.pressure[i];
  force = part.node_map.sum_all(force);
  CHECK(force == doctest::Approx(2 * press / ring_compliance(thick, 0.3)).epsilon(0.03));
  CHECK(length(solution.result.contact_force) < 1e-5 * force);
}

TEST_CASE("a ring pressed on its foot by a plane: the force of a curved beam, no friction to speak of") {
  const double thick = 0.1, press = 1e-3, poisson = 0.3, compliance = ring_compliance(thick, poisson);
  for (const double unit : {1.0, 1e-3, 1e3}) {
    CAPTURE(unit);
    const Frame frame{Rotation(2, 0.4), unit};
    Model model;
    model.materials.push_back({everything(), elastic_law(1.0, poisson)});
    model.boundary.push_back(moved(named("foot"), 2));
    const double top = 1 + thick / 2 - press;
    model.contact.push_back(
        on_plane(named("upper"), frame.place({0, top, 0}), frame.turn({0, -1, 0}), 0.0, 0.3));
    Part part;
    const Solution solution = solve_everywhere(build_problem(ring(280, 6, thick, frame), model), model, part);
    CAPTURE(solution.result.message);
    CHECK(solution.result.status == Status::converged);
    const double force = -product(solution.result.contact_force, frame.turn({0, 1, 0}));
    CHECK(force == doctest::Approx(press / compliance * unit).epsilon(0.03));
    CHECK(length(solution.result.friction_force) < 1e-3 * force);
  }
}
