// SPDX-License-Identifier: BSD-3-Clause
// Validation of models: the messages use the terms of the case file; unconstrained rigid-body modes are
// named.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/problem.hpp>
#include "problem_models.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

/// A model with one entry of each kind.
Model sample() {
  Model model;
  model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
  model.boundary.push_back(displacement(named("left"), {0.0, 0.0, std::nullopt}));
  model.boundary.push_back(traction(named("right"), {0.0, -0.1, 0.0}));
  ContactEntry plane, sphere;
  plane.on = named("bottom");
  plane.obstacle = Plane{{0, 0, 0}, {0, 1, 0}};
  plane.friction = Friction{0.01, 0.0};
  sphere.on = box({0, 0, 0}, {1, 1, 0});
  sphere.obstacle = Sphere{{0, 3, 0}, 1.0, Vector3{0, 1, 0}};
  model.contact = {plane, sphere};
  model.probes.push_back({1, 1, 0});
  return model;
}

template <class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string complaint_about(const std::function<void(Model&)>& change) {
  Model model = sample();
  change(model);
  return complaint([&] { validate(model); });
}

}  // namespace

TEST_CASE("what makes sense is accepted") {
  CHECK_NOTHROW(validate(sample()));
  CHECK_NOTHROW(validate(SolverOptions()));
}

TEST_CASE("options: the path of the key, what was expected, what was there") {
  using Options = SolverOptions;
  struct Row {
    std::function<void(Options&)> change;
    const char* message;
  };
  const std::vector<Row> rows{
      {[](Options& o) { o.tolerance = 0.0; },
       "solver.tolerance: expected a number above 0 and below 1, got 0"},
      {[](Options& o) { o.tolerance = std::nan(""); },
       "solver.tolerance: expected a number above 0 and below 1 of a magnitude below 1e100, got nan"},
      {[](Options& o) { o.spectrum_tolerance = 1.0; },
       "solver.spectrum_tolerance: expected a number above 0 and below 1, got 1"},
      {[](Options& o) { o.penalty = Options::Penalty::fixed; },
       "solver.r: expected \"auto\", \"paper\" or a number > 0, got 0"},
      {[](Options& o) { o.max_outer = 0; }, "solver.max_outer: expected a whole number ≥ 1, got 0"},
      {[](Options& o) { o.max_contact = -3; }, "solver.max_contact: expected a whole number ≥ 1, got -3"},
      {[](Options& o) { o.max_cg = 0; }, "solver.max_cg: expected a whole number ≥ 1, got 0"},
      {[](Options& o) { o.coarse_amg = -1; }, "solver.coarse_amg: expected a whole number ≥ 0, got -1"},
      {[](Options& o) {
         o.load_steps = {0.5, -0.25, 1.0};
       },
       "solver.load_steps[1]: expected a factor ≥ 1e-15, got -0.25"},
      {[](Options& o) {
         o.load_steps = {0.25, 0.5};
       },
       "solver.load_steps: expected factors on the load of which the last is 1, got [0.25,0.5]"},
      {[](Options& o) { o.relaxation = 2.0; }, "solver.relaxation: expected a number ≥ 1 and below 2, got 2"},
      {[](Options& o) {
         o.contact = Options::Contact::active_set;
         o.stop = Options::Stop::paper;
       },
       "solver.contact: \"active_set\" together with the stop \"paper\" is not available; use the stop "
       "\"kkt\""},
      {[](Options& o) {
         o.outer = Options::Outer::newton;
         o.contact = Options::Contact::dual_admm;
       },
       "solver.outer: \"newton\" together with this value of solver.contact is not available; use \"auto\" "
       "or "
       "\"kacanov\""},
  };
  for (const Row& row : rows) {
    CHECK(complaint_about([&](Model& model) { row.change(model.solver); }) == row.message);
    Options options;
    row.change(options);
    CHECK(complaint([&] { validate(options); }) == row.message);
  }
}

TEST_CASE("models: the path of the key, what was expected, what was there") {
  struct Row {
    std::function<void(Model&)> change;
    const char* message;
  };
  const std::vector<Row> rows{
      {[](Model& m) { m.materials.clear(); }, "material: expected at least one material, got []"},
      {[](Model& m) { m.materials[0].law.shear = -1.0; },
       "material[0].law.shear: expected a number > 0, got -1"},
      {[](Model& m) { m.boundary[0].on.name.clear(); }, "boundary[0].on: expected a string, got \"\""},
      {[](Model& m) { m.boundary[1].pressure = 1.0; },
       "boundary[1]: expected only one of the keys displacement, traction, pressure, body_force, "
       "total_force, normal, spring, node_spring, node_force, temperature, got 2"},
      {[](Model& m) { m.boundary[1].traction.reset(); },
       "boundary[1]: expected one of the keys displacement, traction, pressure, body_force, total_force, "
       "normal, spring, node_spring, node_force, temperature, got "
       "0"},
      {[](Model& m) { m.boundary[0].displacement->fill(std::nullopt); },
       "boundary[0].displacement: expected at least one component that is not null, got [null,null,null]"},
      {[](Model& m) { (*m.boundary[0].displacement)[1] = HUGE_VAL; },
       "boundary[0].displacement[1]: expected a number of a magnitude below 1e100, got inf"},
      {[](Model& m) { (*m.boundary[1].traction)[2] = 1e101; },
       "boundary[1].traction[2]: expected a number of a magnitude below 1e100, got 1e+101"},
      {[](Model& m) { std::get<Plane>(m.contact[0].obstacle).normal = {}; },
       "contact[0].obstacle.plane.normal: expected a vector that is not zero, got [0,0,0]"},
      {[](Model& m) { std::get<Sphere>(m.contact[1].obstacle).radius = -2.0; },
       "contact[1].obstacle.sphere.radius: expected a number > 0, got -2"},
      {[](Model& m) { std::get<Sphere>(m.contact[1].obstacle).direction = Vector3{}; },
       "contact[1].obstacle.sphere.direction: expected a vector that is not zero, got [0,0,0]"},
      {[](Model& m) { m.contact[0].friction->coulomb = -0.1; },
       "contact[0].friction.coulomb: expected a number ≥ 0, got -0.1"},
      {[](Model& m) {
         m.contact[1].on.lower = {2, 0, 0};
       },
       "contact[1].on.box: expected a lower corner that is below the upper one in every direction, got "
       "[[2,0,0],[1,1,0]]"},
      {[](Model& m) { m.contact[0].obstacle = ConstantGap{std::nan("")}; },
       "contact[0].obstacle.gap: expected a number of a magnitude below 1e100, got nan"},
      {[](Model& m) { m.probes[0][1] = -1e200; },
       "probe[0][1]: expected a number of a magnitude below 1e100, got -1e+200"},
  };
  for (const Row& row : rows) CHECK(complaint_about(row.change) == row.message);
}

TEST_CASE("build_problem asks first") {
  Model model = sample();
  model.solver.tolerance = 2.0;
  CHECK(complaint([&] {
          build_problem(make_box({{1, 1, 1}, {2, 2, 2}, ElementType::tri3}), model);
        }) == "solver.tolerance: expected a number above 0 and below 1, got 2");
}

namespace {

constexpr auto none = std::nullopt;

/// Two copies of a mesh side by side that share no node.
Mesh twice(const Mesh& one, double offset) {
  Mesh two = one;
  const std::size_t dim = one.dim();
  const auto nodes = static_cast<std::int32_t>(one.node_count());
  for (std::size_t k = 0; k < one.coordinates.size(); ++k) {
    two.coordinates.push_back(one.coordinates[k] + (k % dim == 0 ? offset : 0.0));
  }
  for (const std::int32_t node : one.elements) two.elements.push_back(node + nodes);
  two.groups.clear();
  find_boundary(two);
  return two;
}

}  // namespace

TEST_CASE("a body without any hold: all motions are named") {
  const std::string solid = refusal(box_mesh(ElementType::tet4), elastic_model());
  for (const char* motion :
       {"nothing holds the body against", "translation along x", "translation along y", "translation along z",
        "rotation about x", "rotation about y", "rotation about z"}) {
    CHECK(mentions(solid, motion));
  }
  const std::string plane = refusal(box_mesh(ElementType::tri3), elastic_model());
  CHECK(mentions(plane, "rotation about z, translation along x, translation along y"));
  CHECK_FALSE(mentions(plane, "rotation about x"));
}

TEST_CASE("only what is free is named") {
  const Mesh mesh = box_mesh(ElementType::hex8);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("bottom"), {none, none, 0.0}));
  const std::string message = refusal(mesh, model);
  CHECK(mentions(message, "rotation about z, translation along x, translation along y;"));
  model.boundary.push_back(displacement(named("left"), {0.0, none, none}));
  CHECK(mentions(refusal(mesh, model), "against translation along y;"));
  model.boundary.push_back(displacement(named("front"), {none, 0.0, none}));
  const Problem problem = build_problem(mesh, model);
  CHECK(problem.loose_modes == 0);
  CHECK(problem.warnings.empty());
}

TEST_CASE("a hinge is a rotation about its own line") {
  Mesh mesh = box_mesh(ElementType::tet4);
  std::vector<std::int32_t> edge;
  for (std::size_t node = 0; node < mesh.node_count(); ++node) {
    if (mesh.coordinates[3 * node] == 2.0 && mesh.coordinates[3 * node + 2] == 0.0) {
      edge.push_back(static_cast<std::int32_t>(node));
    }
  }
  mesh.groups.push_back({"hinge", 1, edge});
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("hinge"), {0.0, 0.0, 0.0}));
  CHECK(mentions(refusal(mesh, model), "against rotation about y through (2, 0.5, 0);"));
}

TEST_CASE("modes that the contact alone holds are counted and warned of") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("left"), {0.0, none, none}));
  model.boundary.push_back(displacement(named("front"), {none, 0.0, none}));
  CHECK(mentions(refusal(mesh, model), "against translation along z;"));
  model.contact.push_back({named("bottom"), Plane{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}, none});
  const Problem problem = build_problem(mesh, model);
  CHECK(problem.loose_modes == 1);
  REQUIRE(problem.warnings.size() == 1);
  CHECK(mentions(problem.warnings[0], "only the contact holds the body against translation along z"));
}

TEST_CASE("friction holds what a frictionless plane does not") {
  const Mesh mesh = box_mesh(ElementType::tri3);
  Model model = elastic_model();
  const Plane floor{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  model.contact.push_back({named("bottom"), floor, none});
  CHECK(mentions(refusal(mesh, model), "against translation along x;"));
  model.contact[0].friction = Friction{0.0, 0.0};
  CHECK(mentions(refusal(mesh, model), "against translation along x;"));
  model.contact[0].friction = Friction{0.1, 0.0};
  CHECK(build_problem(mesh, model).loose_modes == 3);
}

TEST_CASE("every piece of a mesh must be held") {
  const Mesh mesh = twice(box_mesh(ElementType::tet4), 5.0);
  Model model = elastic_model();
  model.boundary.push_back(displacement(box({0.0, 0.0, 0.0}, {0.0, 1.0, 1.0}), {0.0, 0.0, 0.0}));
  const std::string message = refusal(mesh, model);
  CHECK(mentions(message,
                 "the piece of the body with element 97 (96 of 192 elements; the mesh falls into 2 pieces)"));
  model.boundary.push_back(displacement(box({5.0, 0.0, 0.0}, {5.0, 1.0, 1.0}), {0.0, 0.0, 0.0}));
  CHECK(build_problem(mesh, model).loose_modes == 0);
}

TEST_CASE("unknown parts are refused with those that exist, and a guess") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("lfet"), {0.0, 0.0, 0.0}));
  CHECK(refusal(mesh, model) ==
        "boundary[0].on: no part is called \"lfet\" (did you mean \"left\"?); there are: all, back, bottom, "
        "front, "
        "left, right, top");
  model.boundary[0].on = named("left");
  model.materials[0].on = named("left");
  CHECK(mentions(refusal(mesh, model),
                 "material[0].on: the part \"left\" is made of boundary facets, expected elements"));
}
