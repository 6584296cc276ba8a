// SPDX-License-Identifier: BSD-3-Clause
// Bodies with pressures for the tests of their multigrid.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "support.hpp"

namespace kacanov::testing {

/// A bar of tet10 with its volume by corners, held at one end; `graded`: cells ever wider along its axes.
inline Part bar(int cells, bool graded) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Model model = elastic_model();
  model.materials[0].formulation = MaterialEntry::Formulation::mixed;
  model.boundary.push_back(moved(named("left"), 3));
  if (rank > 0) return distribute(nullptr, MPI_COMM_WORLD);
  Mesh mesh = make_box({{2, 1, 1}, {2 * cells, cells, cells}, ElementType::tet10});
  for (std::size_t i = 0; graded && i < mesh.coordinates.size(); ++i) {
    const double length = i % 3 == 0 ? 2.0 : 1.0;
    mesh.coordinates[i] = length * std::expm1(2.5 * mesh.coordinates[i] / length) / std::expm1(2.5);
  }
  const Problem problem = build_problem(mesh, model);
  return distribute(&problem, MPI_COMM_WORLD);
}

/// g of a bent bar: it falls by `jump` towards the upper and lower side near the support.
inline Vector bent(const Part& part, double jump) {
  const Body body = part.body();
  Vector at(3 * body.secant_count()), volume(body.secant_count()), g(body.secant_count());
  reference::points(body, at, volume);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double depth = std::max(0.0, 1.0 - at[3 * i] / 0.9) * std::abs(at[3 * i + 2] - 0.5) * 2.0;
    g[i] = body.law(i / 4).shear * std::pow(jump, -std::min(1.0, 1.6 * depth));
  }
  return g;
}

}  // namespace kacanov::testing
