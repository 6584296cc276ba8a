// SPDX-License-Identifier: BSD-3-Clause
// Bodies that only contact supports: whether their loads can be balanced, their initial position, the
// messages.
#include <doctest/doctest.h>

#include <string>

#include "problem/rigid_modes.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A block of size 2 × 1 × 0.5 on the plane z = 0, under its weight and with this friction.
Model block_under(const Vector3& weight, double coulomb, double tresca = 0.0) {
  Model model = elastic_model();
  model.boundary.push_back(body_force(everything(), weight));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, tresca, coulomb));
  return model;
}

/// Returns the weight of a block on an incline of this slope, in the block's frame.
Vector3 on_incline(double slope, double turn) {
  const double angle = std::atan(slope), along = 1e-3 * std::sin(angle);
  return {along * std::cos(turn), along * std::sin(turn), -1e-3 * std::cos(angle)};
}

/// A unit cube, guided at two sides, at height `gap` above a plane, with a pressure on its top.
Model guided_cube(double gap, double push) {
  Model model = elastic_model();
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named("front"), 1));
  model.boundary.push_back(traction(named("top"), {0, 0, push}));
  model.contact.push_back(on_plane(named("bottom"), {0, 0, -gap}, {0, 0, 1}));
  return model;
}

/// Returns the warnings of a run that a piece is free to move.
std::string free_to_move(const Mesh& mesh, const Model& model) {
  const Run run = run_alone(mesh, model);
  CHECK(run.result().status == Status::converged);
  std::string found;
  for (const std::string& warning : run.result().warnings)
    if (mentions(warning, "free to move")) found += warning;
  return found;
}

}  // namespace

TEST_CASE("a block on an incline slides as soon as the slope is beyond its friction coefficient") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  for (const double coulomb : {0.1, 0.3, 0.9})
    for (const double turn : {0.0, 0.7, pi / 2, 4.0}) {
      CAPTURE(coulomb);
      CAPTURE(turn);
      const auto slides = [&](double slope) {
        return build_problem(mesh, block_under(on_incline(slope, turn), coulomb)).no_equilibrium;
      };
      CHECK(slides(coulomb * (1 - 1e-6)) == "");
      const std::string message = slides(coulomb * (1 + 1e-6));
      CHECK(mentions(message, "slides"));
    }
  const std::string message = build_problem(mesh, block_under(on_incline(0.62, 0.0), 0.3)).no_equilibrium;
  CHECK(mentions(message, "no equilibrium: the body slides (translation along x)"));
  CHECK(mentions(message, "needs a friction coefficient of 0.62, and that of the contact is 0.3"));
}

TEST_CASE("Tresca's friction on its own area balances what it can") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  // Volume 1, area 2: the friction stress needed is half the force.
  const auto slides = [&](double force) {
    return build_problem(mesh, block_under({force, 0, -1e-3}, 0.0, 1e-4)).no_equilibrium;
  };
  CHECK(slides(2e-4 * 0.9999) == "");
  CHECK(mentions(slides(2e-4 * 1.0001), "it needs friction 1 times as large"));
  CHECK(mentions(slides(6e-4), "it needs friction 3 times as large"));
}

TEST_CASE("what tips over is lifted, and no friction helps") {
  const Mesh mesh = make_box({{1, 1, 4}, {2, 2, 4}, ElementType::hex8});
  Model model = elastic_model();
  model.boundary.push_back(traction(named("top"), {0.2e-3, 0, -1e-3}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.0, 0.9));
  const std::string message = build_problem(mesh, model).no_equilibrium;
  CHECK(mentions(message, "lifts the body off what alone holds it (rotation about y through (1"));
  // With half of the load it does not slide.
  model.boundary[0].traction = Vector3{0.1e-3, 0, -1e-3};
  CHECK(build_problem(mesh, model).no_equilibrium == "");
}

TEST_CASE("a pull off the only contact ends the run before it begins") {
  const Mesh mesh = box_mesh(ElementType::hex8);
  const Run run = run_alone(mesh, guided_cube(0.0, 1e-3));
  CHECK(run.result().status == Status::not_converged);
  CHECK(run.result().operator_applications == 0);
  CHECK(mentions(run.result().message, "no equilibrium: the load lifts the body off"));
  CHECK(mentions(run.result().message, "translation along z"));
}

TEST_CASE("a block on one node can tip over") {
  // The resultant of the load passes through the only node that reaches the needle.
  Model model = elastic_model();
  model.boundary.push_back(body_force(everything(), {0, 0, -1e-3}));
  const Mesh mesh = make_box({{2, 1, 0.5}, {2, 2, 1}, ElementType::hex8});
  model.contact.push_back({named("bottom"), Sphere{{1, 0.5, -1}, 1.0, {}}, Friction{0.0, 0.5}});
  const std::string found = free_to_move(mesh, model);
  CHECK(mentions(found, "(rotation about x through (1, 0.5, 0), rotation about y through (1, 0.5, 0), "));
  CHECK(!mentions(found, "translation"));
}

TEST_CASE("load steps in which nothing presses a loose body are named") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  const auto unpressed = [&](std::vector<double> factors) {
    Model model = block_under({1e-4, 0, -1e-3}, 0.5);
    double time = 0.0;
    for (const double factor : factors) model.steps.push_back({time += 1.0, {{"boundary[0]", factor}}});
    return free_to_move(mesh, model);
  };
  CHECK(unpressed({0.5, 1.0, 0.25}) == "");
  const std::string end = unpressed({1.0, 0.5, 0.0});
  CHECK(mentions(end, "the contact that holds the body leaves it free to move (rotation about x, "));
  CHECK(mentions(unpressed({1.0, 0.0, 0.5}), "load step 2 of 3 (time 2): the contact that holds the body"));
}

TEST_CASE("a gap costs a falling body no steps") {
  const Mesh mesh = make_box({{1, 1, 1}, {3, 3, 3}, ElementType::hex8});
  int fewest = 1000, most = 0;
  for (const double gap : {0.0, 0.001, 0.1, 1.0, 10.0}) {
    CAPTURE(gap);
    Model model = guided_cube(gap, -1e-3);
    model.probes.push_back({1, 1, 1});
    const Run run = run_alone(mesh, model);
    CHECK(run.result().status == Status::converged);
    CHECK(run.result().contact_force[2] == doctest::Approx(1e-3));
    CHECK(run.probe()[2] == doctest::Approx(-gap - 1e-3).epsilon(1e-5));
    fewest = std::min(fewest, run.result().contact_iterations < 1000
                                  ? static_cast<int>(run.result().contact_iterations)
                                  : 1000);
    most = std::max(most, static_cast<int>(run.result().contact_iterations));
  }
  CHECK(most <= 2 * fewest + 5);
}

TEST_CASE("two pieces: each has its own balance and its own fall") {
  Mesh mesh = box_mesh(ElementType::tet4, {1, 1, 1}, 1);
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  const std::vector<double> first = mesh.coordinates;
  for (std::size_t k = 0; k < first.size(); ++k)
    mesh.coordinates.push_back(first[k] + (k % 3 == 0 ? 3.0 : k % 3 == 2 ? 0.25 : 0.0));
  const std::vector<std::int32_t> elements = mesh.elements;
  for (const std::int32_t node : elements) mesh.elements.push_back(node + nodes);
  mesh.groups.clear();
  find_boundary(mesh);
  Model model = elastic_model();
  model.boundary.push_back(body_force(everything(), {0, 0, -1e-3}));
  model.contact.push_back(on_plane(everything(), {}, {0, 0, 1}, 0.0, 0.5));
  const Problem problem = build_problem(mesh, model);
  CHECK(problem.no_equilibrium == "");
  REQUIRE(problem.motions.size() == 2);
  REQUIRE(problem.motion_of_node.size() == mesh.node_count());
  CHECK(problem.motion_of_node.front() != problem.motion_of_node.back());
  CHECK(std::abs(problem.motions[0].shift[2]) < 1e-2);
  CHECK(problem.motions[1].shift[2] == doctest::Approx(-0.25).epsilon(0.02));
  model.solver.tolerance = 1e-8;
  const Run run = run_alone(mesh, model);
  CHECK(run.result().status == Status::converged);
  CHECK(run.result().contact_force[2] == doctest::Approx(2e-3));
}

TEST_CASE("a body that nothing loads and nothing touches is at rest, and that is a solution") {
  Model model = elastic_model();
  model.boundary.push_back(moved(named("bottom"), 3));
  ContactEntry ball;
  ball.on = named("top");
  ball.obstacle = Sphere{{1, 0.5, 2}, 0.7, std::nullopt};
  model.contact.push_back(ball);
  CHECK(run_alone(box_mesh(ElementType::tet4), model).result().status == Status::converged);
}

TEST_CASE("rigid balance: reactions in a cone") {
  // Motions along x and z; one contact point with μ = 0.5.
  RigidContact point;
  point.normal = Eigen::Vector2d(0, -1);
  point.tangent = {Eigen::Vector2d(1, 0)};
  point.mass = 1.0;
  point.coulomb = 0.5;
  CHECK(balance({point}, Eigen::Vector2d(0.499999, -1)).exists);
  const RigidBalance slides = balance({point}, Eigen::Vector2d(0.6, -1));
  CHECK_FALSE(slides.exists);
  // The load does work on the motion, which leaves the cone: −z at most half of x.
  CHECK(slides.motion.dot(Eigen::Vector2d(0.6, -1)) > 0.0);
  CHECK(slides.motion(1) == doctest::Approx(0.5 * slides.motion(0)));
  CHECK(friction_needed({point}, Eigen::Vector2d(0.6, -1)) == doctest::Approx(1.2));
  CHECK_FALSE(std::isfinite(friction_needed({point}, Eigen::Vector2d(0, 1))));
  CHECK(balance({point}, Eigen::Vector2d(0, 0)).exists);
  // On springs of stiffness 4 it sinks by load / stiffness beyond its gap.
  point.gap = 0.7;
  const Eigen::VectorXd rest = rest_on_springs({point}, Eigen::Vector2d(0.1, -1), 4.0);
  CHECK(rest(1) == doctest::Approx(-0.7 - 0.25));
  CHECK(rest(0) == doctest::Approx(0.1 / 4.0));
}
