// SPDX-License-Identifier: BSD-3-Clause
// Runs of small problems, and helpers that evaluate their results.
#pragma once

#include <mpi.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include "problem_models.hpp"

namespace kacanov::testing {

/// A problem, its single part, and the solution.
struct Run {
  Problem problem;
  Part part;
  Solution solution;

  const Result& result() const { return solution.result; }
  const Vector3& probe(std::size_t i = 0) const { return solution.result.probe.at(i); }
};

inline Run run_alone(Mesh mesh, const Model& model, const RunOptions& options = {}) {
  Run run;
  run.problem = build_problem(std::move(mesh), model);
  run.part = distribute(&run.problem, MPI_COMM_SELF);
  run.solution = solve(run.part, model.solver, options);
  return run;
}

inline Part over_all_ranks(const Problem& problem) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return distribute(rank == 0 ? &problem : nullptr, MPI_COMM_WORLD);
}

/// Distributes a problem that every rank has and solves it on all ranks; `part` becomes this rank's part.
inline Solution solve_everywhere(const Problem& problem, const Model& model, Part& part) {
  part = distribute(&problem, MPI_COMM_WORLD);
  return solve(part, model.solver, {});
}

/// Returns nodal displacements of a part from a function of position.
template <class Field>
std::vector<double> nodal_field(const Part& part, const Field& field) {
  const std::size_t dim = part.dim();
  std::vector<double> u(part.unknowns());
  for (std::size_t n = 0; n < part.nodes(); ++n) {
    Vector3 x{};
    for (std::size_t c = 0; c < dim; ++c) x[c] = part.coordinates[n * dim + c];
    const Vector3 value = field(x);
    for (std::size_t c = 0; c < dim; ++c) u[n * dim + c] = value[c];
  }
  return u;
}

inline Law logarithmic_law(double x0, double young = 1.0, double poisson = 0.3) {
  Law law = elastic_law(young, poisson);
  law.form = laws::Logarithmic{x0};
  return law;
}

inline Law hardening_law(double x0, double gamma) {
  Law law = elastic_law(1.0, 0.3);
  law.form = laws::LinearHardening{x0, gamma};
  return law;
}

inline ContactEntry on_plane(Selector on, const Vector3& point, const Vector3& normal, double tresca = 0.0,
                             double coulomb = 0.0) {
  ContactEntry entry;
  entry.on = std::move(on);
  entry.obstacle = Plane{point, normal};
  if (tresca > 0.0 || coulomb > 0.0) entry.friction = Friction{tresca, coulomb};
  return entry;
}

/// Roller: one displacement component is zero.
inline BoundaryEntry roller(Selector on, std::size_t component) {
  std::array<std::optional<double>, 3> value{};
  value[component] = 0.0;
  return displacement(std::move(on), value);
}

/// Prescribes all displacement components; the third is omitted in 2D.
inline BoundaryEntry moved(Selector on, int dim, const Vector3& u = {}) {
  std::array<std::optional<double>, 3> value{u[0], u[1], std::nullopt};
  if (dim == 3) value[2] = u[2];
  return displacement(std::move(on), value);
}

/// The paper's beam [0,4]×[0,1] (×[0,1] in 3D, z up): fixed at x = 0, loaded by f on the far half of its top,
/// its bottom on a plane. All selections are boxes, so that they fit any mesh of the beam.
inline Model beam(int dim, const Law& law, double f, double tresca = 0.0) {
  const std::size_t up = dim - 1;
  Vector3 normal{}, load{}, far{4, 1, dim == 3 ? 1.0 : 0.0}, under = far, end = far, top{2, 0, 0}, tip = far;
  normal[up] = 1.0;
  load[up] = -f;
  under[up] = 0.0;
  end[0] = 0.0;
  top[up] = 1.0;
  if (dim == 3) tip[1] = 0.5;
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(moved(box({}, end), dim));
  model.boundary.push_back(traction(box(top, far), load));
  model.contact.push_back(on_plane(box({}, under), {}, normal, tresca));
  model.probes.push_back(tip);
  return model;
}

inline Mesh beam_mesh(int dim, int n) {
  BoxSpec spec;
  spec.size = {4, 1, 1};
  spec.cells = {4 * n, n, n};
  spec.type = dim == 2 ? ElementType::tri3 : ElementType::tet4;
  return make_box(spec);
}

/// Moves every node; the boundary and the groups do not change.
inline void map_nodes(Mesh& mesh, const std::function<Vector3(const Vector3&)>& map) {
  const std::size_t dim = mesh.dim();
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    double* x = mesh.coordinates.data() + i * dim;
    const Vector3 y = map({x[0], x[1], dim == 3 ? x[2] : 0.0});
    for (std::size_t c = 0; c < dim; ++c) x[c] = y[c];
  }
}

/// Rotation by a fixed angle about a fixed axis (about z in 2D).
struct Rotation {
  std::array<Vector3, 3> row{};

  Rotation(int dim, double angle) {
    const Vector3 axis = dim == 2 ? Vector3{0, 0, 1} : Vector3{2.0 / 7, 3.0 / 7, 6.0 / 7};
    const double c = std::cos(angle), s = std::sin(angle);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) row[i][j] = (1 - c) * axis[i] * axis[j] + (i == j ? c : 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      row[j][k] -= s * axis[i];
      row[k][j] += s * axis[i];
    }
  }
  Vector3 operator()(const Vector3& x) const {
    Vector3 y{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) y[i] += row[i][j] * x[j];
    return y;
  }
};

inline double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
inline double length(const Vector3& a) { return distance(a, {}); }

/// A block fixed at its left end with its right end displaced downwards, so that the energy is the strain
/// energy alone.
inline Model bent_model(int dim, const Law& law) {
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(moved(named("left"), dim));
  Vector3 down{};
  down[static_cast<std::size_t>(dim) - 1] = -0.02;
  model.boundary.push_back(moved(named("right"), dim, down));
  model.solver.tolerance = 1e-8;
  return model;
}

}  // namespace kacanov::testing
