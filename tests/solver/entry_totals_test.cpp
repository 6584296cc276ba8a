// SPDX-License-Identifier: BSD-3-Clause
// Forces and moments of every boundary and contact entry, on any number of ranks: balance and closed-form
// values.
#include <doctest/doctest.h>

#include <algorithm>

#include "problem/vector3.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

Run run_on_all(Mesh mesh, const Model& model) {
  Run run;
  run.problem = build_problem(std::move(mesh), model);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  run.part = distribute(rank == 0 ? &run.problem : nullptr, MPI_COMM_WORLD);
  run.solution = solve(run.part, model.solver, {});
  return run;
}

constexpr std::array types{ElementType::tri3, ElementType::quad4, ElementType::tet4, ElementType::tet10,
                           ElementType::hex8};

/// A block on two obstacles, with supports and loads that share nodes.
Model random_model(int dim, std::mt19937& draw) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(draw()) / 4294967296.0;
  };
  const std::size_t up = dim - 1;
  Vector3 pull{}, turn{}, floor{}, wall{};
  for (std::size_t c = 0; c <= up; ++c) pull[c] = uniform(-0.05, 0.05), turn[c] = uniform(-0.05, 0.05);
  pull[up] = -0.1;
  floor[up] = 1.0;
  wall[0] = -1.0;
  Vector3 below{}, beside{2.01, 0.0, 0.0};
  below[up] = uniform(-0.01, 0.01);
  const double coulomb = uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.2, tresca = coulomb > 0.0 ? 0.0 : 0.01;
  Model model = elastic_model();
  if (uniform(0.0, 1.0) < 0.7) model.materials[0].law = logarithmic_law(0.05);
  model.boundary.push_back(moved(named("left"), dim, {uniform(-0.02, 0.02), 0.0, 0.0}));
  model.boundary.push_back(roller(dim == 3 ? named("front") : box({}, {0.5, 0, 0}), 1));
  model.boundary.push_back(traction(named("top"), pull));
  model.boundary.push_back(pressure(named("right"), uniform(-0.05, 0.05)));
  model.boundary.push_back(body_force(everything(), turn));
  model.contact.push_back(on_plane(named("bottom"), below, floor, tresca, coulomb));
  model.contact.push_back(on_plane(named("right"), beside, wall, tresca, coulomb));
  model.solver.tolerance = 1e-9;
  return model;
}

Resultant sum_of(const Result& result, double& largest) {
  Resultant sum;
  const auto add = [&](const Resultant& total) {
    sum.force = sum.force + total.force;
    sum.moment = sum.moment + total.moment;
    largest = std::max({largest, norm(total.force), norm(total.moment)});
  };
  for (const ContactTotals& contact : result.contact) add(contact.total);
  for (const BoundaryTotals& support : result.reaction) add(support.total);
  for (const BoundaryTotals& load : result.load) add(load.total);
  return sum;
}

void check_same(const Resultant& a, const Resultant& b, double tolerance) {
  CHECK(norm(a.force - b.force) <= tolerance);
  CHECK(norm(a.moment - b.moment) <= tolerance);
}

}  // namespace

TEST_CASE("loads, supports and obstacles are in balance, in force and moment, however many ranks") {
  std::mt19937 draw(7);
  for (int k = 0; k < 20; ++k) {
    const ElementType type = types[static_cast<std::size_t>(k) % types.size()];
    CAPTURE(k);
    Mesh mesh = box_mesh(type);
    const Model model = random_model(mesh.dim(), draw);
    map_nodes(mesh, [](const Vector3& x) {
      return Vector3{x[0] + 0.03 * x[1] * x[1], x[1] + 0.02 * x[0] * x[2], x[2] + 0.02 * x[0] * x[0] * x[1]};
    });
    const Run run = run_on_all(mesh, model);
    REQUIRE(run.result().status == Status::converged);
    double largest = 0.0;
    const Resultant sum = sum_of(run.result(), largest);
    CHECK(norm(sum.force) <= 1e-8 * largest);
    CHECK(norm(sum.moment) <= 1e-8 * largest);
    // Each total equals that of a run on one rank.
    const Run alone = run_alone(mesh, model);
    REQUIRE(run.result().contact.size() == 2);
    REQUIRE(run.result().reaction.size() == 2);
    REQUIRE(run.result().load.size() == 3);
    for (std::size_t i = 0; i < 2; ++i) {
      check_same(run.result().contact[i].total, alone.result().contact[i].total, 1e-6 * largest);
      check_same(run.result().reaction[i].total, alone.result().reaction[i].total, 1e-6 * largest);
    }
    // The totals of all contact are the sums over the entries.
    Vector3 normal{}, friction{};
    for (const ContactTotals& contact : run.result().contact) {
      normal = normal + contact.normal_force;
      friction = friction + contact.friction_force;
      CHECK(norm(contact.total.force - contact.normal_force - contact.friction_force) <= 1e-12 * largest);
    }
    CHECK(norm(normal - run.result().contact_force) <= 1e-12 * largest);
    CHECK(norm(friction - run.result().friction_force) <= 1e-12 * largest);
  }
}

TEST_CASE("loads have the force and moment of what is put on") {
  for (const ElementType type : types) {
    CAPTURE(static_cast<int>(type));
    const Mesh mesh = box_mesh(type, {2.0, 1.0, 0.5});
    const int dim = mesh.dim();
    const double depth = dim == 3 ? 0.5 : 1.0;
    Model model = elastic_model();
    model.boundary.push_back(moved(named("left"), dim));
    model.boundary.push_back(pressure(named("right"), 3.0));
    model.boundary.push_back(body_force(everything(), {0.0, -2.0, 0.0}));
    BoundaryEntry pulled;
    pulled.on = named("right");
    pulled.total_force = Vector3{0.0, 5.0, 0.0};
    pulled.name = "hook";
    model.boundary.push_back(pulled);
    CHECK(entry_name(model.boundary[3], 3) == "hook");
    CHECK(entry_name(model.boundary[2], 2) == "boundary[2]");
    const Run run = run_on_all(mesh, model);
    const auto& load = run.result().load;
    REQUIRE(load.size() == 3);
    const double z = dim == 3 ? 0.25 : 0.0;  // of the mid-plane
    const Vector3 pushed{-3.0 * depth, 0.0, 0.0}, weight{0.0, -4.0 * depth, 0.0}, hook{0.0, 5.0, 0.0};
    check_same(load[0].total, {pushed, cross({2.0, 0.5, z}, pushed)}, 1e-13);
    check_same(load[1].total, {weight, cross({1.0, 0.5, z}, weight)}, 1e-13);
    check_same(load[2].total, {hook, cross({2.0, 0.5, z}, hook)}, 1e-13);
    REQUIRE(run.result().reaction.size() == 1);
    const Vector3 held = -1.0 * (pushed + weight + hook);
    CHECK(norm(run.result().reaction[0].total.force - held) <= 1e-5);
  }
}

TEST_CASE("loads are those of the share, or of the load curves, that was reached") {
  const Mesh mesh = box_mesh(ElementType::quad4);
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), 2));
  model.boundary.push_back(traction(named("right"), {0.1, 0.0, 0.0}));
  model.boundary.push_back(traction(named("top"), {0.0, 0.1, 0.0}));
  model.boundary[1].name = "hook";
  model.steps = {{1.0, {{"hook", 1.0}}}, {2.0, {{"hook", -0.5}, {"boundary[2]", 3.0}}}};
  const Run run = run_on_all(mesh, model);
  REQUIRE(run.result().status == Status::converged);
  REQUIRE(run.result().load.size() == 2);
  CHECK(run.result().load[0].total.force[0] == doctest::Approx(-0.05));
  CHECK(run.result().load[1].total.force[1] == doctest::Approx(0.6));
  CHECK(run.result().reaction[0].total.force[0] == doctest::Approx(0.05).epsilon(1e-5));
  CHECK(run.result().reaction[0].total.force[1] == doctest::Approx(-0.6).epsilon(1e-5));
  model.steps.clear();
  model.solver.load_steps = {0.5, 1.0};
  CHECK(run_on_all(mesh, model).result().load[0].total.force[0] == doctest::Approx(0.1));
  model.contact.push_back(on_plane(named("bottom"), {0, -1, 0}, {0, 1, 0}));
  model.contact[0].name = "hook";
  CHECK(mentions(refusal(mesh, model), "contact[0].name: expected another name than that of boundary[1]"));
}

TEST_CASE("a reaction of several entries is divided among them evenly, component by component") {
  // Tension along x between rollers; two entries fix the left side, and a third fixes only the bottom's z.
  const Mesh mesh = box_mesh(ElementType::hex8, {2.0, 1.0, 1.0});
  Model model = elastic_model();
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(displacement(named("left"), {0.0, 0.0, std::nullopt}));
  model.boundary.push_back(roller(named("bottom"), 2));
  model.boundary.push_back(traction(named("right"), {0.1, 0.0, 0.0}));
  const Run run = run_on_all(mesh, model);
  const auto& reaction = run.result().reaction;
  REQUIRE(reaction.size() == 3);
  CHECK(reaction[0].total.force[0] == doctest::Approx(-0.05).epsilon(1e-5));
  CHECK(reaction[1].total.force[0] == doctest::Approx(-0.05).epsilon(1e-5));
  CHECK(std::abs(reaction[2].total.force[0]) <= 1e-12);
}

TEST_CASE("two entries of one floor bear each what stands on them") {
  for (const ElementType type : types) {
    CAPTURE(static_cast<int>(type));
    if (type == ElementType::tet10) continue;  // uniform pressure has unequal nodal values
    const Mesh mesh = box_mesh(type, {2.0, 1.0, 1.0});
    const int dim = mesh.dim();
    const std::size_t up = dim - 1;
    Vector3 normal{}, near{0.5, 0, 0}, far{2, 0, 0};
    normal[up] = 1.0;
    if (dim == 3) near[1] = far[1] = 1.0;
    Model model = elastic_model();
    model.materials[0].law = elastic_law(1.0, 0.0);
    model.boundary.push_back(roller(named("left"), 0));
    if (dim == 3) model.boundary.push_back(roller(named("front"), 1));
    model.boundary.push_back(pressure(named("top"), 0.01));
    model.contact.push_back(on_plane(box({}, near), {}, normal));
    model.contact.push_back(on_plane(box({0.5, 0, 0}, far), {}, normal));
    model.contact[1].name = "right foot";
    model.solver.tolerance = 1e-9;
    const Run run = run_on_all(mesh, model);
    REQUIRE(run.result().contact.size() == 2);
    const ContactTotals &left = run.result().contact[0], &right = run.result().contact[1];
    CHECK(left.total.force[up] == doctest::Approx(0.005).epsilon(1e-7));
    CHECK(right.total.force[up] == doctest::Approx(0.015).epsilon(1e-7));
    CHECK(left.area == doctest::Approx(0.5).epsilon(1e-12));
    CHECK(right.area == doctest::Approx(1.5).epsilon(1e-12));
    CHECK(left.max_pressure == doctest::Approx(0.01).epsilon(1e-6));
    CHECK(left.open == 0);
    CHECK(left.sticking == 0);
    CHECK(std::abs(left.least_gap) <= 1e-9);
    // Both entries count the nodes between them.
    const auto between = static_cast<std::int64_t>(dim == 3 ? 3 : 1);
    CHECK(left.slipping + right.slipping == run.result().contact_nodes + between);
  }
}

TEST_CASE("a plane and a ball that pinch a block push back what each is pushed with") {
  const Mesh mesh = box_mesh(ElementType::hex8, {1.0, 1.0, 1.0});
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("left"), {0.0, 0.0, std::nullopt}));
  model.contact.push_back(on_plane(named("bottom"), {0, 0, 0.005}, {0, 0, 1}));
  ContactEntry ball;
  ball.on = named("top");
  ball.obstacle = Sphere{{0.5, 0.5, 2.99}, 2.0, Vector3{0, 0, 1}};
  model.contact.push_back(ball);
  model.solver.tolerance = 1e-8;
  const Run run = run_on_all(mesh, model);
  REQUIRE(run.result().status == Status::converged);
  const ContactTotals &floor = run.result().contact[0], &top = run.result().contact[1];
  CHECK(floor.total.force[2] > 1e-4);
  CHECK(top.total.force[2] == doctest::Approx(-floor.total.force[2]).epsilon(1e-6));
  CHECK(floor.first_gap == doctest::Approx(-0.005));
  CHECK(top.first_gap == doctest::Approx(-0.01));
}

TEST_CASE("extremes have a value and a place that do not depend on the ranks") {
  const Mesh mesh = box_mesh(ElementType::tet4, {2.0, 1.0, 0.5});
  Model model = elastic_model();
  // Uniaxial tension: u = (0.01 x, −0.3 · 0.01 y, −0.3 · 0.01 z).
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named("front"), 1));
  model.boundary.push_back(roller(named("bottom"), 2));
  model.boundary.push_back(traction(named("right"), {0.01, 0.0, 0.0}));
  model.solver.tolerance = 1e-10;
  const Result result = run_on_all(mesh, model).solution.result;
  CHECK(result.max_strain.value == doctest::Approx(0.01).epsilon(1e-8));
  CHECK(result.max_rotation.value <= 1e-10);
  const Vector3 corner{2.0, 1.0, 0.5}, u{0.02, -0.003, -0.0015};
  CHECK(result.max_displacement.value == doctest::Approx(norm(u)).epsilon(1e-8));
  CHECK(norm(result.max_displacement.at - corner) <= 1e-14);
  CHECK(result.max_displacement.tag == static_cast<std::int64_t>(mesh.node_count()));
  CHECK(result.body.volume == doctest::Approx(1.0).epsilon(1e-13));
  CHECK(result.body.size == doctest::Approx(norm(corner)).epsilon(1e-15));
  CHECK(norm(result.body.lower) == 0.0);
  CHECK(result.plastic_share == 0.0);
}

TEST_CASE("a rigid turn has rotation and no strain") {
  const Mesh mesh = box_mesh(ElementType::hex8, {1.0, 1.0, 1.0});
  const int dim = 3;
  const Problem problem = build_problem(mesh, [&] {
    Model model = elastic_model();
    model.boundary.push_back(moved(named("left"), dim));
    return model;
  }());
  const Part part = distribute(&problem, MPI_COMM_SELF);
  std::vector<double> u(part.unknowns());
  const Vector3 turn{0.01, -0.02, 0.02};
  for (std::size_t n = 0; n < part.nodes(); ++n) {
    const double* x = &part.coordinates[3 * n];
    const Vector3 moved = cross(turn, {x[0], x[1], x[2]});
    std::copy(moved.begin(), moved.end(), u.begin() + static_cast<std::ptrdiff_t>(3 * n));
  }
  std::vector<double> strain(part.element_count()), rotation(strain.size());
  reference::ElementFields wanted;
  wanted.strain = strain;
  wanted.rotation = rotation;
  reference::fields(part.body(), u, wanted);
  for (std::size_t e = 0; e < strain.size(); ++e) {
    CHECK(strain[e] <= 1e-15);
    CHECK(rotation[e] == doctest::Approx(0.03).epsilon(1e-12));
  }
}
