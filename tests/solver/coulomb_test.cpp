// SPDX-License-Identifier: BSD-3-Clause
// Coulomb friction in the Newton step: its operator, nodes with several contact points, and the solved
// system.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <random>
#include <string>
#include <vector>

#include "contact/active_constraints.hpp"
#include "linear/gcr.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A cube in the corner of floor and wall, both with friction; with `across` also against a wall at y = 0.
Model cube_in_corner(const Vector3& load, double coulomb, bool across = false) {
  Model model = elastic_model();
  model.boundary.push_back(traction(named("top"), load));
  if (!across) model.boundary.push_back(roller(named("front"), 1));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.0, coulomb));
  model.contact.push_back(on_plane(named("left"), {}, {1, 0, 0}, 0.0, coulomb));
  if (across) model.contact.push_back(on_plane(named("front"), {}, {0, 1, 0}, 0.0, coulomb));
  return model;
}

Mesh cube(int cells, ElementType type = ElementType::tet4) {
  return make_box({{1, 1, 1}, {cells, cells, cells}, type});
}

/// An active set of all points, sticking, or with `slips` slipping in a fixed direction.
ActiveSet touching(const Part& part, bool slips) {
  const std::size_t points = part.contact.size();
  ActiveSet set;
  set.held.assign(points, {true, !slips});
  set.slip_force.assign(2 * points, 0.0);
  set.slip_stiffness.assign(points, 0.0);
  set.slip_direction.assign(2 * points, 0.0);
  set.coulomb.assign(points, 0.0);
  for (std::size_t i = 0; i < points && slips; ++i) {
    set.coulomb[i] = part.contact[i].coulomb;
    set.slip_direction[2 * i] = 0.6;
    set.slip_direction[2 * i + 1] = 0.8;
  }
  return set;
}

/// A state, the same on every call.
ContactState some_state(const Part& part, const Traces& traces) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  ContactState state;
  for (std::size_t i = 0; i < part.unknowns(); ++i) state.u.push_back(part.held[i] ? 0.0 : value(random));
  state.trace = ContactValues(part.contact.size());
  traces.evaluate(state.u, state.trace);
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    state.gap.push_back(part.contact[i].gap);
    state.bound.push_back(1.0 + 0.1 * static_cast<double>(i));
  }
  return state;
}

}  // namespace

TEST_CASE("gcr solves what is not symmetric, with as good a preconditioner as there is") {
  const Problem problem = build_problem(cube(2), cube_in_corner({0, 0, -1}, 0.3));
  const Part part = distribute(&problem, MPI_COMM_SELF);
  const Space space(part);
  const auto n = static_cast<Eigen::Index>(part.unknowns());
  std::srand(1);
  Eigen::MatrixXd matrix = 0.1 * Eigen::MatrixXd::Random(n, n) + Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd wanted = Eigen::VectorXd::Random(n), right = matrix * wanted;
  Vector x(part.unknowns(), 0.0), residual(right.data(), right.data() + n);
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    Eigen::Map<Eigen::VectorXd>(q.data(), n) = matrix * Eigen::Map<const Eigen::VectorXd>(p.data(), n);
  };
  const auto inner = [](std::span<const double> r, std::span<double> z) {
    std::copy(r.begin(), r.end(), z.begin());
    return true;
  };
  const GcrResult result = gcr(space, apply, inner, {x, residual}, {1e-10, 200});
  CHECK(result.converged);
  CHECK(result.iterations > 3);
  CHECK((Eigen::Map<Eigen::VectorXd>(x.data(), n) - wanted).norm() < 1e-8);
  const auto refuses = [](std::span<const double>, std::span<double>) { return false; };
  Vector other(part.unknowns(), 0.0), rest(right.data(), right.data() + n);
  CHECK_FALSE(gcr(space, apply, refuses, {other, rest}, {1e-10, 200}).converged);
}

TEST_CASE(
    "nodes of several entries: closing closes, reactions are the force, friction what the normals leave") {
  for (const bool slips : {false, true}) {
    CAPTURE(slips);
    const Problem problem = build_problem(cube(2), cube_in_corner({0, 0, -1}, 0.3, true));
    const Part part = distribute(&problem, MPI_COMM_SELF);
    const Traces traces(part);
    const ContactState state = some_state(part, traces);
    const ActiveSet set = touching(part, slips);
    const HeldNodes nodes(part, set, state);
    CHECK(nodes.oblique() == slips);

    Vector closed(part.unknowns(), 0.0);
    CHECK(nodes.close(closed) > 0.0);
    for (std::size_t i = 0; i < closed.size(); ++i) closed[i] += state.u[i];
    ContactValues trace(part.contact.size());
    traces.evaluate(closed, trace);
    for (std::size_t i = 0; i < part.contact.size(); ++i) {
      CHECK(std::abs(trace.normal[i] - state.gap[i]) < 1e-12);
      if (!slips) CHECK(std::hypot(trace.tangential[2 * i], trace.tangential[2 * i + 1]) < 1e-12);
    }

    // Forces in the range of the reactions are recovered: the remainder has zero trace.
    Vector force = state.u;
    nodes.subtract_sliding(force);
    ContactValues lambda(part.contact.size());
    nodes.reactions(state.u, lambda);
    Vector rest = state.u;
    ContactValues whole = lambda;
    for (std::size_t i = 0; i < part.contact.size() && slips; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        whole.tangential[2 * i + k] = set.coulomb[i] * lambda.normal[i] * set.slip_direction[2 * i + k];
    traces.add_force(whole, -1.0, rest);
    ContactValues left(part.contact.size());
    traces.evaluate(rest, left);
    for (std::size_t i = 0; i < part.contact.size(); ++i) {
      CHECK(std::abs(left.normal[i]) < 1e-10);
      if (!slips) CHECK(std::hypot(left.tangential[2 * i], left.tangential[2 * i + 1]) < 1e-10);
      // At the edge of two obstacles friction acts along the edge only.
      std::size_t entries = 0;
      Vector3 traction{}, other{};
      for (std::size_t j = 0; j < part.contact.size(); ++j)
        if (part.contact[j].node == part.contact[i].node) {
          ++entries;
          if (j != i) other = part.contact[j].normal;
        }
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t c = 0; c < 3; ++c)
          traction[c] += lambda.tangential[2 * i + k] * part.contact[i].tangent[k][c];
      if (!slips && entries > 1)
        CHECK(std::abs(traction[0] * other[0] + traction[1] * other[1] + traction[2] * other[2]) < 1e-10);
    }
  }
}

TEST_CASE("a cube in a corner converges under any friction, in few steps") {
  for (const bool across : {false, true})
    for (const double coulomb : {0.1, 0.3, 0.6, 1.0})
      for (const Vector3& load : {Vector3{-0.5e-3, 0, -1e-3}, Vector3{-0.2e-3, -0.3e-3, -1e-3}}) {
        CAPTURE(across);
        CAPTURE(coulomb);
        CAPTURE(load[1]);
        const Run run = run_alone(cube(3), cube_in_corner(load, coulomb, across));
        CHECK(run.result().status == Status::converged);
        CHECK(run.result().outer_iterations <= 12);
      }
}

TEST_CASE("shear that friction holds is held: nothing slips, nothing is sheared off") {
  Model model = elastic_model();
  model.materials[0].law = elastic_law(1.0, 0.0);
  model.boundary.push_back(traction(named("top"), {1e-4, 0, -1e-3}));
  model.boundary.push_back(traction(named("right"), {0, 0, 1e-4}));
  model.boundary.push_back(traction(named("left"), {0, 0, -1e-4}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.0, 0.15));
  model.solver.tolerance = 1e-9;
  const Run run = run_alone(cube(4, ElementType::hex8), model);
  CHECK(run.result().status == Status::converged);
  CHECK(run.result().slip_nodes == 0);
  CHECK(run.result().friction_force[0] == doctest::Approx(-1e-4));
  CHECK(run.result().max_contact_pressure == doctest::Approx(1e-3));
  for (std::size_t i = 0; i < run.part.contact.size(); ++i)
    CHECK(run.solution.traction[i][0] == doctest::Approx(-1e-4));
}
