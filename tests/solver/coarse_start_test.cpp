// SPDX-License-Identifier: BSD-3-Clause
// Location of points in elements, and initial guesses from a coarser mesh: the same answer in fewer
// iterations.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>

#include <kacanov/coarse_solution.hpp>
#include "problem/point_location.hpp"
#include "problem/shapes.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

Mesh beam_mesh(ElementType type, int across) {
  BoxSpec spec;
  spec.type = type;
  spec.size = {4.0, 1.0, 1.0};
  spec.cells = {4 * across, across, across};
  return make_box(spec);
}

/// Clamped on the left, pressed on a floor with friction, beyond yield.
Model rubbing_beam(int dim, const Friction& friction) {
  Vector3 load{}, up{};
  load[dim - 1] = -0.03;
  load[0] = 0.005;
  up[dim - 1] = 1.0;
  Model model;
  model.materials.push_back({everything(), logarithmic_law(0.01)});
  model.boundary.push_back(moved(named("left"), dim));
  model.boundary.push_back(traction(named("top"), load));
  ContactEntry floor = on_plane(named("bottom"), {}, up);
  floor.friction = friction;
  model.contact.push_back(floor);
  model.probes.push_back({4.0, 0.5, dim == 3 ? 1.0 : 0.0});
  return model;
}

}  // namespace

TEST_CASE("a point is found in an element that has it, with its reference coordinates") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(0.0, 1.0), shift(-0.04, 0.04);
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    Mesh mesh = beam_mesh(type, 3);
    const std::size_t dim = mesh.dim(), npe = nodes_per_element(type);
    for (double& x : mesh.coordinates) x += (cell(type).order == 1 ? 1.0 : 0.5) * shift(random);  // or curves
    const PointLocator locator(mesh.view());
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3 x{0.1 + 3.8 * at(random), 0.1 + 0.8 * at(random),
                      dim == 3 ? 0.1 + 0.8 * at(random) : 0.0};
      const PointLocator::Place place = locator.find(x);
      CHECK(outside(cell(type), place.at) <= 1e-9);
      const Shapes shapes = shapes_at(cell(type), place.at);
      for (std::size_t c = 0; c < dim; ++c) {
        double sum = 0.0;
        for (std::size_t a = 0; a < npe; ++a) {
          const std::size_t node = mesh.elements[static_cast<std::size_t>(place.element) * npe + a];
          sum += shapes.value[a] * mesh.coordinates[node * dim + c];
        }
        CHECK(sum == doctest::Approx(x[c]).epsilon(1e-9));
      }
    }
    // A point outside the body: the nearest element, at that end.
    const PointLocator::Place end = locator.find({4.5, 0.5, dim == 3 ? 0.5 : 0.0});
    double most = 0.0;
    for (std::size_t a = 0; a < npe; ++a) {
      const std::size_t node = mesh.elements[static_cast<std::size_t>(end.element) * npe + a];
      most = std::max(most, mesh.coordinates[node * dim]);
    }
    CHECK(most > 3.5);
  }
}

TEST_CASE("a linear field and constant tractions are carried over exactly") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const Model model = rubbing_beam(dimension(type), {0.01, 0.0});
    const Problem coarse = build_problem(beam_mesh(type, 2), model);
    const Problem fine = build_problem(beam_mesh(type, 3), model);
    const Part from = distribute(&coarse, MPI_COMM_SELF), to = distribute(&fine, MPI_COMM_SELF);
    const std::size_t dim = from.dim();
    const auto linear = [&](const Part& part, std::size_t i) {
      const double* x = &part.coordinates[i / dim * dim];
      return 0.3 * x[0] - 0.2 * x[1] + static_cast<double>(i % dim) + (dim == 3 ? 0.7 * x[2] : 0.0);
    };
    Solution solution;
    for (std::size_t i = 0; i < from.unknowns(); ++i) solution.displacement.push_back(linear(from, i));
    solution.pressure.assign(from.contact.size(), 2.0);
    solution.traction.assign(from.contact.size(), {0.25, 0.0, 0.0});
    const Start start = interpolate(whole_solution(from, &coarse, solution), to);
    for (std::size_t i = 0; i < to.unknowns(); ++i)
      CHECK(start.displacement[i] == doctest::Approx(linear(to, i)).epsilon(1e-10));
    for (std::size_t i = 0; i < to.contact.size(); ++i) {
      CHECK(start.pressure[i] == doctest::Approx(2.0).epsilon(1e-9));
      double along = 0.0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(to.contact[i].tangents); ++k)
        along -= start.friction[2 * i + k] * to.contact[i].tangent[k][0];
      CHECK(along == doctest::Approx(0.25).epsilon(1e-9));
    }
  }
}

TEST_CASE("a start from a coarser mesh leads to the same answer in fewer iterations") {
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::tet10})
    for (const Friction& friction : {Friction{0.01, 0.0}, Friction{0.0, 0.3}}) {
      CAPTURE(cell(type).name);
      CAPTURE(friction.coulomb);
      const Model model = rubbing_beam(dimension(type), friction);
      const int across = type == ElementType::tri3 ? 16 : 4;
      const Run coarse = run_alone(beam_mesh(type, across / 2), model);
      const Run alone = run_alone(beam_mesh(type, across), model);
      REQUIRE(alone.result().status == Status::converged);
      const CoarseSolution from = whole_solution(coarse.part, &coarse.problem, coarse.solution);
      RunOptions options;
      options.coarse = {&from, 1};
      const Run started = run_alone(beam_mesh(type, across), model, options);
      CHECK(started.result().status == Status::converged);
      CHECK(started.probe()[0] == doctest::Approx(alone.probe()[0]).epsilon(1e-5));
      CHECK(started.probe()[1] == doctest::Approx(alone.probe()[1]).epsilon(1e-5));
      CHECK(started.result().outer_iterations <= alone.result().outer_iterations);
      CHECK(started.result().operator_applications < alone.result().operator_applications);
    }
}

TEST_CASE("load steps start each from its own on a coarser mesh, with the same answers in fewer iterations") {
  for (const auto reference : {Friction::Reference::start, Friction::Reference::step}) {
    CAPTURE(static_cast<int>(reference));
    Model model = rubbing_beam(3, {0.0, 0.3, reference});
    model.solver.load_steps = {0.3, 0.7, 1.0};
    std::vector<CoarseSolution> from;
    RunOptions options;
    const Problem coarse = build_problem(beam_mesh(ElementType::tet10, 2), model);
    Part part = distribute(&coarse, MPI_COMM_SELF);
    options.load_step_over = [&](const Part& now, const Solution& step) {
      from.push_back(whole_solution(now, &coarse, step));
    };
    from.push_back(whole_solution(part, &coarse, solve(part, model.solver, options)));
    REQUIRE(from.size() == 3);
    const Run alone = run_alone(beam_mesh(ElementType::tet10, 4), model);
    options.load_step_over = {};
    options.coarse = from;
    const Run started = run_alone(beam_mesh(ElementType::tet10, 4), model, options);
    REQUIRE(alone.result().status == Status::converged);
    REQUIRE(started.result().status == Status::converged);
    CHECK(started.result().operator_applications < alone.result().operator_applications);
    REQUIRE(started.result().load_steps.size() == 3);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(started.result().load_steps[k].probe[0][c] ==
              doctest::Approx(alone.result().load_steps[k].probe[0][c]).epsilon(1e-5).scale(0.01));
  }
}
