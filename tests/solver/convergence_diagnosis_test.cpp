// SPDX-License-Identifier: BSD-3-Clause
// Diagnosis of runs that do not converge: which contact nodes keep changing their state.
#include <doctest/doctest.h>

#include <sstream>

#include "nonlinear/convergence_diagnosis.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A block pressed on the floor with friction.
Model pressed() {
  Model model;
  model.materials.push_back({everything(), elastic_law(210e3, 0.3)});
  model.boundary.push_back(moved(named("left"), 3));
  model.boundary.push_back(traction(named("top"), {0, 0, -20.0}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}, 0.0, 0.3));
  return model;
}

}  // namespace

TEST_CASE("the node that changes most is named with its place in the user's units") {
  const Problem problem = build_problem(box_mesh(ElementType::tet4), pressed());
  const Part part = distribute(&problem, MPI_COMM_SELF);
  const std::size_t points = part.contact.size();
  ContactState state;
  state.trace = state.phi = state.lambda = ContactValues(points);
  state.lambda.normal.assign(points, 1.0);
  state.bound.assign(points, 0.3);
  ContactChanges changes;
  const std::size_t first = 3, second = 5;
  for (int step = 0; step < 12; ++step) {
    state.lambda.normal[first] = step % 2;  // with its bound: open, or sticking
    state.bound[first] = 0.3 * (step % 2);
    state.lambda.tangential[2 * second] = step % 4 < 2 ? 0.0 : 0.3;  // sticks, then slips
    changes.note(part.contact.points(), state);
  }
  CHECK(changes.count(first) == 11);
  CHECK(changes.count(second) == 5);
  CHECK(changes.count(0) == 0);
  const std::string said = who_cycles(part, changes, 2.0);
  const std::int32_t node = part.contact[first].node;
  std::ostringstream place;
  place << "node " << part.node_tag(node) << " at (" << 2.0 * part.coordinates[3 * node] << ", "
        << 2.0 * part.coordinates[3 * node + 1] << ", 0)";
  CHECK(mentions(said, place.str()));
  CHECK(mentions(said, "in 11 of the last 16 steps, and 1 contact points more"));
  // Points that stop changing are forgotten.
  for (int step = 0; step < ContactChanges::window; ++step) changes.note(part.contact.points(), state);
  CHECK(who_cycles(part, changes, 1.0).empty());
}

TEST_CASE("a run cut short says which residual is left") {
  Model model = pressed();
  model.materials[0].law.form = laws::Logarithmic{1e-6};
  model.solver.max_outer = 1;
  const Run run = run_alone(box_mesh(ElementType::tet4), model);
  REQUIRE(run.result().status == Status::not_converged);
  CHECK(mentions(run.result().message, "; largest is "));
  CHECK(mentions(run.result().message, "no contact node goes to and fro"));
}
