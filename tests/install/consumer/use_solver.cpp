// SPDX-License-Identifier: BSD-3-Clause
// A block pressed onto a plane through the installed solver: the obstacle carries the load.
#include <mpi.h>
#include <kacanov/solve.hpp>

#include <cmath>
#include <utility>

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  kacanov::Model model;
  model.materials.push_back({{}, kacanov::elastic_law(1.0, 0.3)});
  kacanov::BoundaryEntry load{.on = {.kind = kacanov::Selector::Kind::name, .name = "top"}};
  load.pressure = 0.01;
  kacanov::BoundaryEntry side{.on = {.kind = kacanov::Selector::Kind::name, .name = "left"}};
  side.displacement = {{0.0, std::nullopt, std::nullopt}};
  kacanov::BoundaryEntry front{.on = {.kind = kacanov::Selector::Kind::name, .name = "front"}};
  front.displacement = {{std::nullopt, 0.0, std::nullopt}};
  model.boundary = {load, side, front};
  model.contact.push_back(
      {{.kind = kacanov::Selector::Kind::name, .name = "bottom"}, kacanov::Plane{{0, 0, 0}, {0, 0, 1}}, {}});
  kacanov::BoxSpec box;
  box.cells = {3, 3, 3};
  const kacanov::Problem problem = kacanov::build_problem(kacanov::make_box(box), model);
  kacanov::Part part = kacanov::distribute(&problem, MPI_COMM_WORLD);
  const kacanov::Result result = kacanov::solve(part, model.solver, {}).result;
  MPI_Finalize();
  const bool carried = std::abs(result.contact_force[2] - 0.01) < 1e-6;
  return result.status == kacanov::Status::converged && carried ? 0 : 1;
}
