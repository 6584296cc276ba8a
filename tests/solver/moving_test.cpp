// SPDX-License-Identifier: BSD-3-Clause
// Obstacles that move, are relinearised or are pushed, against fixed obstacles and closed-form solutions.
#include <doctest/doctest.h>

#include <algorithm>

#include <kacanov/solve.hpp>
#include <kacanov/surface.hpp>
#include "half_space.hpp"
#include "moving/obstacle_motion.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

Run run_moving(const Mesh& mesh, Model model) {
  model = with_curves(model);
  Run run;
  const bool first = [] {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
  }();
  if (first) run.problem = build_problem(mesh, model);
  run.part = distribute(first ? &run.problem : nullptr, MPI_COMM_WORLD);
  run.solution = solve_moving(run.part, model, {});
  return run;
}

Run run_still(const Mesh& mesh, const Model& model) {
  Run run;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) run.problem = build_problem(mesh, model);
  run.part = distribute(rank == 0 ? &run.problem : nullptr, MPI_COMM_WORLD);
  run.solution = solve(run.part, model.solver, {});
  return run;
}

Mesh slab() { return make_box({{2, 1, 0.5}, {10, 5, 3}, ElementType::hex8}); }

/// A slab fixed at its top, over an obstacle.
Model over(const Obstacle& obstacle) {
  Model model;
  model.materials.push_back({everything(), elastic_law(200.0, 0.3)});
  model.boundary.push_back(moved(named("top"), 3));
  model.contact.push_back({named("bottom"), obstacle, std::nullopt});
  return model;
}

Sphere ball(double height) { return {{1, 0.5, height - 2}, 2.0, Vector3{0, 0, -1}}; }

Motion lift(double height) {
  Motion motion;
  motion.path.push_back({1.0, {0, 0, height}, {}});
  return motion;
}

void agree(const Run& a, const Run& b, double accuracy) {
  REQUIRE(a.result().status == Status::converged);
  REQUIRE(b.result().status == Status::converged);
  const double size = length(b.result().contact_force);
  CHECK(distance(a.result().contact_force, b.result().contact_force) < accuracy * size);
  CHECK(distance(a.result().friction_force, b.result().friction_force) < accuracy * size);
  CHECK(a.result().active_nodes == b.result().active_nodes);
}

}  // namespace

TEST_CASE("an obstacle that has moved presses as one that stands there: at once, in steps, on any ranks") {
  const Run there = run_still(slab(), over(ball(0.01)));
  for (const int steps : {1, 4}) {
    Model model = over(ball(0.0));
    model.contact[0].motion = lift(0.01);
    for (int k = 1; k <= steps; ++k) model.solver.load_steps.push_back(static_cast<double>(k) / steps);
    const Run moved_there = run_moving(slab(), model);
    agree(moved_there, there, 1e-5);
    REQUIRE(moved_there.result().load_steps.size() == static_cast<std::size_t>(steps));
    CHECK(moved_there.result().load_steps.front().active_nodes <= there.result().active_nodes);
    int sum = 0;
    for (const LoadStep& step : moved_there.result().load_steps) sum += step.outer_iterations;
    CHECK(sum == moved_there.result().outer_iterations);
  }
}

TEST_CASE("a plane that turns about an axis carries its points along; a path goes from place to place") {
  const double angle = 0.01;
  Model model = over(Plane{{}, {0, 0, 1}});
  model.contact[0].motion = Motion{{1, 0, 0}, {{0.5, {0, 0, 0.002}, {}}, {1.0, {}, {0, -angle, 0}}}};
  model.solver.load_steps = {0.5, 1.0};
  const Run turned = run_moving(slab(), model);
  REQUIRE(turned.result().status == Status::converged);
  CHECK(turned.result().load_steps.front().contact_force[2] > 0);
  // Heights of points on the rotated plane: (x − 1) sin.
  for (std::size_t i = 0; i < turned.part.contact.size(); ++i) {
    const double x = node_of(turned, i)[0];
    CHECK(turned.part.contact[i].gap == doctest::Approx(-(x - 1) * std::sin(angle)).epsilon(1e-12));
  }
}

TEST_CASE("faced anew, a ball rolls along under a slab as if it had been put there") {
  Model model = over(Sphere{{0.5, 0.5, -1.99}, 2.0, {}});
  model.contact[0].motion = Motion{{}, {{1.0, {1, 0, 0}, {}}}};
  model.contact[0].relinearise = true;
  model.solver.load_steps = {0.5, 1.0};
  const Run rolled = run_moving(slab(), model);
  const Run there = run_still(slab(), over(Sphere{{1.5, 0.5, -1.99}, 2.0, {}}));
  REQUIRE(rolled.result().status == Status::converged);
  // Runs differ in the position from which each node is projected onto the ball: the displacement, one per
  // cent.
  const Vector3 a = rolled.result().contact_force, b = there.result().contact_force;
  CHECK(distance(a, b) < 0.03 * length(b));
  const Vector3 middle = rolled.result().load_steps.front().contact_force;
  CHECK(std::abs(middle[0]) < 1e-3 * middle[2]);
}

TEST_CASE("faced anew where it has come to, a node sits on the true obstacle") {
  // A large indentation: without relinearisation a node is kept off a tangent plane, with it off the ball
  // itself.
  std::vector<double> distances;
  for (const bool anew : {false, true}) {
    Model model = over(Sphere{{1, 0.5, -0.75}, 0.75, {}});
    model.contact[0].motion = lift(0.1);
    model.contact[0].relinearise = anew;
    for (int k = 1; k <= 8; ++k) model.solver.load_steps.push_back(k / 8.0);
    const Run run = run_moving(slab(), model);
    REQUIRE(run.result().status == Status::converged);
    double off = 0.0;
    for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
      if (!(run.solution.pressure[i] > 0.0)) continue;
      const double* x = node_of(run, i);
      const double* u = &run.solution.displacement[3 * static_cast<std::size_t>(run.part.contact[i].node)];
      const double far = std::hypot(x[0] + u[0] - 1, x[1] + u[1] - 0.5, x[2] + u[2] + 0.65);
      off = std::max(off, std::abs(far - 0.75));
    }
    distances.push_back(run.part.node_map.max_all(off));
  }
  CAPTURE(distances[0]);
  CAPTURE(distances[1]);
  CHECK(distances[1] < 0.1 * distances[0]);
}

TEST_CASE("an obstacle that drags along by friction: slip counts from where it has gone") {
  const double drag = 0.004;
  for (const bool by_step : {false, true}) {
    Model model = over(Plane{{0, 0, 0.002}, {0, 0, 1}});
    model.contact[0].friction = Friction{0.0, 10.0};  // all points stick
    if (by_step) model.contact[0].friction->reference = Friction::Reference::step;
    Model pulled = model;
    model.contact[0].motion = Motion{{}, {{1.0, {drag, 0, 0}, {}}}};
    model.solver.load_steps = by_step ? std::vector{0.25, 1.0} : std::vector{1.0};
    // The same in the obstacle's frame: it is fixed, and the top moves the other way.
    pulled.boundary[0] = moved(named("top"), 3, {-drag, 0, 0});
    pulled.contact[0].friction->reference = Friction::Reference::start;
    agree(run_moving(slab(), model), run_still(slab(), pulled), 1e-4);
  }
}

TEST_CASE("slip of an entry at rest counts from its reference, whatever moves beside it") {
  for (const auto reference : {Friction::Reference::start, Friction::Reference::step}) {
    Model model = over(Plane{{0, 0, 0}, {0, 0, 1}});
    model.boundary[0] = moved(named("top"), 3, {0.004, 0, 0});
    model.boundary.push_back(traction(named("left"), {0.2, 0, -0.1}));
    model.contact[0].friction = Friction{0.0, 0.3, reference};
    model.contact[0].obstacle = Plane{{0, 0, 0.002}, {0, 0, 1}};
    model.contact.push_back({named("right"), Plane{{9, 0, 0}, {-1, 0, 0}}, std::nullopt});
    model.steps = {{1.0, {{"boundary[0]", 0.0}, {"boundary[1]", 1.0}, {"contact[0]", 1.0}}},
                   {2.0, {{"boundary[0]", 1.0}}},
                   {3.0, {{"boundary[0]", 0.4}, {"boundary[1]", 0.5}}}};
    const Run still = run_still(slab(), model);
    model.contact[1].motion = lift(0.01);
    agree(run_moving(slab(), model), still, 1e-5);
    model.contact[1].motion.reset();
    model.contact[1].relinearise = true;
    agree(run_moving(slab(), model), still, 1e-5);
  }
}

TEST_CASE("a load step that is cut beside an obstacle that moves ends at a time of the step") {
  Model model;
  model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
  model.materials[0].law.form = laws::Saturating{0.002, 2.0};
  // Uniaxial stress has ‖dev τ‖ = √(2/3) σ, which at yield is 2 μ x₀; the limit is three times that.
  const double limit = 3.0 * std::sqrt(1.5) * 2.0 * model.materials[0].law.shear * 0.002;
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named("front"), 1));
  model.boundary.push_back(roller(named("bottom"), 2));
  model.boundary.push_back(traction(named("right"), {limit, 0, 0}));
  model.contact.push_back({named("top"), Plane{{0, 0, 9}, {0, 0, -1}}, std::nullopt});
  model.steps = {{1.0, {{"boundary[3]", 0.1}}}, {2.0, {{"boundary[3]", 1.4}}}};
  const Mesh cube = make_box({{1, 1, 1}, {2, 2, 2}, ElementType::hex8});
  const Run still = run_still(cube, model);
  REQUIRE(still.result().status == Status::not_converged);
  model.contact[0].motion = lift(0.01);
  const Run run = run_moving(cube, model);
  CHECK(run.result().status == Status::not_converged);
  CHECK(run.result().load_reached > 1.0);
  CHECK(run.result().load_reached < 2.0);
  CHECK(run.result().load_reached == doctest::Approx(still.result().load_reached).epsilon(1.0 / 32));
  CHECK(run.result().load_factor == run.result().load_reached);
  CHECK(run.result().load[0].total.force[0] ==
        doctest::Approx(limit * (0.1 + 1.3 * (run.result().load_factor - 1.0))).epsilon(1e-9));
  // Without hardening, the limit load is reached at 1 + 0.9/1.3.
  CHECK(run.result().load_reached < 1.001 + 0.9 / 1.3);
  CHECK(run.result().load_reached > 0.97 + 0.9 / 1.3);
  CHECK(run.result().message.find("obstacles with a motion are where they are at 2") != std::string::npos);
}

TEST_CASE("a tool with friction that has not come yet leaves the body at rest") {
  Model model = over(Sphere{{1.1, 0.4, -3.0}, 2.0, {}});  // an oblique normal: the path has a tangential part
  model.contact[0].motion = lift(1.01);
  model.contact[0].friction = Friction{0.0, 0.3};
  model.solver.load_steps = {0.5, 0.9, 1.0};
  const Run run = run_moving(slab(), model);
  REQUIRE(run.result().status == Status::converged);
  REQUIRE(run.result().load_steps.size() == 3);
  for (const std::size_t step : {0, 1}) {
    CHECK(run.result().load_steps[step].active_nodes == 0);
    CHECK(run.result().load_steps[step].worst_residual == 0.0);
  }
  CHECK(run.result().load_steps[2].active_nodes > 0);
}

TEST_CASE("a ball that is pushed goes as deep as Hertz says of its force, and bears it") {
  const HalfSpace space{4};
  const Law law = elastic_law(1.0, 0.3);
  const double radius = 50.0, depth = 1.0 / radius,
               force = 4.0 / 3.0 * plane_modulus(law) * std::sqrt(radius) * std::pow(depth, 1.5);
  Model model = pressed_ball(law, radius, 0.0);
  model.contact[0].force_controlled = ForceControl{force / 4, {0, 0, 2}};
  const Run pushed = run_moving(space.quarter(), model);
  REQUIRE(pushed.result().status == Status::converged);
  CHECK(pushed.result().contact_force[2] == doctest::Approx(force / 4).epsilon(1.1e-5));
  const double travel = pushed.result().contact[0].travel;
  // Fixed far sides make the body stiffer than a half-space, by the point force's displacement there.
  CHECK(travel == doctest::Approx(depth).epsilon(0.12));
  CHECK(travel < depth);
  agree(pushed, run_still(space.quarter(), pressed_ball(law, radius, travel)), 1e-5);
}

TEST_CASE("an obstacle that is pushed keeps the face that its nodes have at rest") {
  // A groove with slopes of 2e-4 that runs below the middle of a slab with a bottom tilted by a
  // hundredth.
  const double slope = 2e-4;
  const std::vector<Vector3> points{
      {-5, -5, -0.1 + 5.5 * slope}, {5, -5, -0.1 + 5.5 * slope}, {-5, 0.5, -0.1}, {5, 0.5, -0.1},
      {-5, 6, -0.1 + 5.5 * slope},  {5, 6, -0.1 + 5.5 * slope}};
  const SurfaceObstacle groove{
      std::make_shared<const Surface>(Surface(points, {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}}))};
  Mesh tilted = make_box({{2, 1, 0.5}, {6, 4, 2}, ElementType::hex8});
  for (std::size_t n = 0; n < tilted.node_count(); ++n)
    tilted.coordinates[3 * n + 2] += 0.01 * tilted.coordinates[3 * n + 1];
  Model model = over(groove);
  model.contact[0].force_controlled = ForceControl{0.01, {0, 0, 1}};
  const Run pushed = run_moving(tilted, model);
  REQUIRE(pushed.result().status == Status::converged);
  int lowest = 0;
  for (std::size_t i = 0; i < pushed.part.contact.size(); ++i) {
    const double y = node_of(pushed, i)[1];
    const Vector3& normal = pushed.part.contact[i].normal;
    lowest += y == 0.5 ? 1 : 0;
    // Over the lowest line the bottom's outer normal (0, 0.01, −1) selects the face beyond it.
    CHECK(normal[1] == doctest::Approx(y < 0.5 ? -slope : slope).epsilon(1e-6));
  }
  if (pushed.part.node_map.ranks == 1) CHECK(lowest == 7);
}

TEST_CASE("pushed in steps, by a force that grows; in the plane, with a load beside it") {
  Model model;
  model.materials.push_back({everything(), elastic_law(200.0, 0.3)});
  model.boundary.push_back(moved(named("left"), 2));
  model.boundary.push_back(traction(named("top"), {0, 0.05, 0}));
  model.contact.push_back({named("bottom"), Sphere{{3.5, -1.1, 0}, 1.0, {}}, std::nullopt});
  model.contact[0].force_controlled = ForceControl{0.3, {0, 1, 0}};
  model.solver.load_steps = {0.5, 1.0};
  const Run run = run_moving(make_box({{4, 1, 0}, {24, 6, 1}, ElementType::tri3}), model);
  REQUIRE(run.result().status == Status::converged);
  CHECK(run.result().load_steps[0].contact_force[1] == doctest::Approx(0.15).epsilon(1.1e-5));
  CHECK(run.result().load_steps[1].contact_force[1] == doctest::Approx(0.3).epsilon(1.1e-5));
  CHECK(run.result().contact[0].travel > 0.1);
}

TEST_CASE("the search for a travel: few solves for smooth forces, and an honest end") {
  PushedObstacle pushed{.force = 2.0, .tolerance = 1e-9, .touch = 1.0, .scale = 0.1};
  for (const double power : {1.0, 1.5, 2.0, 0.5}) {
    const PushOutcome found =
        find_travel(pushed, [&](double d) { return std::pow(std::max(d - 1.0, 0.0), power); });
    CAPTURE(power);
    CHECK(found.reached);
    CHECK(found.travel == doctest::Approx(1.0 + std::pow(2.0, 1 / power)).epsilon(1e-8));
    CHECK(found.solves < 16);
  }
  pushed.travel = 9.0;  // start from beyond the solution
  CHECK(find_travel(pushed, [](double d) { return std::max(d - 1.0, 0.0); }).reached);
  // A body that reaches its limit load, and a solve that fails.
  CHECK_FALSE(find_travel(pushed, [](double d) { return std::min(std::max(d - 1.0, 0.0), 1.5); }).reached);
  CHECK_FALSE(find_travel(pushed, [](double) { return std::nullopt; }).reached);
}

TEST_CASE("a pose and its inverse; halfway along a path") {
  const Motion motion{{1, 2, 3}, {{1.0, {1, 0, 0}, {0, 0, 1}}, {3.0, {1, 2, 0}, {0, 0, 1}}}};
  const RigidPose pose = RigidPose::at(motion, 2.0);
  CHECK(pose.shift == Vector3{1, 1, 0});
  const Vector3 x{0.3, -0.2, 5};
  CHECK(distance(pose.back(x + pose.carried(x)), x) < 1e-14);
  CHECK(distance(pose.carried({2, 2, 3}), {std::cos(1.0), 1 + std::sin(1.0), 0}) < 1e-14);
  CHECK(RigidPose::at(motion, 0.5).rotation == Vector3{0, 0, 0.5});
  CHECK(RigidPose::at(motion, 9.0).shift == Vector3{1, 2, 0});
}
