// SPDX-License-Identifier: BSD-3-Clause
// Validation of models passed through the library: the messages use the terms of the case file.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/problem.hpp>
#include "problem_models.hpp"

using namespace kacanov;
using namespace kacanov::testing;

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
