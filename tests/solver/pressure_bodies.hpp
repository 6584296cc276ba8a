// SPDX-License-Identifier: BSD-3-Clause
// Bodies with pressures for the tests of their multigrid, and solves on them.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <kacanov/operator.hpp>
#include "amg/make_preconditioner.hpp"
#include "multigrid/cg.hpp"
#include "operator/nodal_pressure.hpp"
#include "support.hpp"

namespace kacanov::testing {

/// A bar of tet10 with dilatation averaged at corners, or of hex8 with B-bar, fixed at one end; with `graded`
/// the cells widen along the axes.
inline Part bar(int cells, bool graded, ElementType type = ElementType::tet10) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Model model = elastic_model();
  model.materials[0].formulation = MaterialEntry::Formulation::mixed;
  model.boundary.push_back(moved(named("left"), 3));
  if (rank > 0) return distribute(nullptr, MPI_COMM_WORLD);
  Mesh mesh = make_box({{2, 1, 1}, {2 * cells, cells, cells}, type});
  for (std::size_t i = 0; graded && i < mesh.coordinates.size(); ++i) {
    const double length = i % 3 == 0 ? 2.0 : 1.0;
    mesh.coordinates[i] = length * std::expm1(2.5 * mesh.coordinates[i] / length) / std::expm1(2.5);
  }
  const Problem problem = build_problem(mesh, model);
  return distribute(&problem, MPI_COMM_WORLD);
}

/// Returns g of a bent bar: it falls by the factor `jump` towards the upper and lower side near the support.
inline Vector bent(const Part& part, double jump) {
  const Body body = part.body();
  Vector at(3 * body.secant_count()), volume(body.secant_count()), g(body.secant_count());
  reference::points(body, at, volume);
  const std::size_t points = points_per_element(body.mesh.type);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double depth = std::max(0.0, 1.0 - at[3 * i] / 0.9) * std::abs(at[3 * i + 2] - 0.5) * 2.0;
    g[i] = body.law(i / points).shear * std::pow(jump, -std::min(1.0, 1.6 * depth));
  }
  return g;
}

/// Returns the number of CG iterations that reduce the residual of a distributed force by eight digits.
/// Elements with k0/g above `contrast` get pressures; 0: always.
inline int iterations(const Part& part, double jump, double contrast = 0.0) {
  const Space space(part);
  Operator op(part.body());
  if (part.node_map.ranks > 1) op.set_corner_sum(CornerSum<double>(corner_means(part.body()), part.node_map));
  const Vector g = bent(part, jump);
  op.set_secant(g);
  MultigridOptions options;
  options.pressure_contrast = options.element_contrast = contrast;
  if (contrast == 0.0) options.grid_contrast = 0.0;
  PartMultigrid multigrid(part, options);
  multigrid.setup(g, {}, space);
  CgWork work;
  work.resize(part.unknowns());
  for (std::size_t i = 0; i < part.unknowns(); ++i)
    work.residual[i] = part.held[i] ? 0.0 : std::sin(0.1 * static_cast<double>(part.node_index[i / 3]));
  Vector u(part.unknowns(), 0.0);
  const CgResult solve = conjugate_gradients(
      space,
      [&](std::span<const double> p, std::span<double> q) {
        const double share = op.apply_dot(p, q);
        part.node_map.sum(q, 3);
        return share;
      },
      [&](std::span<const double> p, std::span<double> q) { multigrid.apply(p, q); }, u, work,
      {0.0, 1e-8, 600});
  CHECK(solve.converged);
  return solve.iterations;
}

}  // namespace kacanov::testing
