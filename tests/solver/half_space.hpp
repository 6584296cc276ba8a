// SPDX-License-Identifier: BSD-3-Clause
// Bodies that approximate elastic half-spaces: blocks with meshes that are fine near the contact and coarsen
// outwards.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "support.hpp"

namespace kacanov::testing {

/// The body fills y > 0 (z > 0 in 3D) up to `extent`; the unit of length is that of the contact. Up to `fine`
/// the cells have size 1/n; beyond, n cells grow exponentially and smoothly, so that
/// meshes of different n form a family.
struct HalfSpace {
  int n = 8;
  double extent = 10.0;
  static constexpr double fine = 1.25;

  int fine_cells() const { return static_cast<int>(std::lround(fine * n)); }
  int cells() const { return fine_cells() + n; }
  double coordinate(double index) const {
    const double beyond = (index - fine_cells()) / n;
    if (beyond <= 0.0) return index / n;
    // The first cell beyond `fine` has size 1/n too.
    const double growth = growth_rate();
    return fine + (extent - fine) * std::expm1(growth * beyond) / std::expm1(growth);
  }
  /// Returns β with β / (e^β − 1) = 1 / (extent − fine).
  double growth_rate() const {
    double beta = 1.0;
    for (int i = 0; i < 100; ++i) beta = std::log1p(beta * (extent - fine));
    return beta;
  }

  /// Returns both halves x < 0 and x > 0; groups left, right, top; the surface is bottom.
  Mesh plane() const {
    Mesh mesh = make_box({{2.0 * cells(), 1.0 * cells(), 0.0}, {2 * cells(), cells(), 1}, ElementType::tri3});
    map_nodes(mesh, [&](const Vector3& x) {
      const double i = x[0] - cells();
      return Vector3{std::copysign(coordinate(std::abs(i)), i), coordinate(x[1]), 0.0};
    });
    return mesh;
  }

  /// Returns the quarter x, y > 0 with symmetry planes left and front; the surface is bottom.
  Mesh quarter(ElementType type = ElementType::hex8) const {
    const double m = cells();
    Mesh mesh = make_box({{m, m, m}, {cells(), cells(), cells()}, type});
    map_nodes(mesh, [&](const Vector3& x) {
      return Vector3{coordinate(x[0]), coordinate(x[1]), coordinate(x[2])};
    });
    straighten(mesh);
    return mesh;
  }

  /// Returns the half y > 0 with symmetry plane front; the surface is bottom.
  Mesh half() const {
    const double m = cells();
    Mesh mesh = make_box({{2 * m, m, m}, {2 * cells(), cells(), cells()}, ElementType::hex8});
    map_nodes(mesh, [&](const Vector3& x) {
      const double i = x[0] - m;
      return Vector3{std::copysign(coordinate(std::abs(i)), i), coordinate(x[1]), coordinate(x[2])};
    });
    return mesh;
  }

  /// Moves mid-edge nodes back to the middle of their straight edge.
  static void straighten(Mesh& mesh) {
    const Cell& type = cell(mesh.type);
    const auto npe = static_cast<std::size_t>(type.nodes);
    for (std::size_t e = 0; e < mesh.element_count(); ++e)
      for (const CellEdge& edge : type.edges) {
        if (edge.middle < 0) continue;
        const auto at = [&](std::int8_t k) {
          return &mesh.coordinates[3 * static_cast<std::size_t>(mesh.elements[e * npe + k])];
        };
        for (std::size_t c = 0; c < 3; ++c) at(edge.middle)[c] = 0.5 * (at(edge.a)[c] + at(edge.b)[c]);
      }
  }
};

/// Boussinesq: returns the displacement of the half-space z > 0 under a force F along z at its origin.
inline Vector3 boussinesq(const Law& law, double force, const Vector3& x) {
  const double nu = (3 * law.bulk - 2 * law.shear) / (6 * law.bulk + 2 * law.shear);
  const double r = std::hypot(x[0], x[1]), rho = std::hypot(r, x[2]), factor = force / (4 * M_PI * law.shear);
  const double along = factor * (x[2] / std::pow(rho, 3) - (1 - 2 * nu) / (rho * (rho + x[2])));
  return {along * x[0], along * x[1], factor * (x[2] * x[2] / std::pow(rho, 3) + 2 * (1 - nu) / rho)};
}

/// Prescribes the displacement under a point force on the far sides, which is what a pressed body feels
/// there.
inline void prescribe_far_field(const HalfSpace& space, const Law& law, double force, Problem& problem) {
  for (std::size_t i = 0; i < problem.mesh.node_count(); ++i) {
    const double* x = &problem.mesh.coordinates[3 * i];
    if (std::max({x[0], x[1], x[2]}) < space.extent * (1 - 1e-9)) continue;
    const Vector3 u = boussinesq(law, force, {x[0], x[1], x[2]});
    for (std::size_t c = 0; c < 3; ++c)
      if (problem.held[3 * i + c]) problem.prescribed[3 * i + c] = u[c];
  }
}

/// Returns E / (1 − ν²).
inline double plane_modulus(const Law& law) {
  const double nu = (3 * law.bulk - 2 * law.shear) / (6 * law.bulk + 2 * law.shear);
  return 2 * law.shear * (1 + nu) / (1 - nu * nu);
}

/// A ball that penetrates the surface of a quarter by `depth` initially, without friction; far sides are
/// fixed.
inline Model pressed_ball(const Law& law, double radius, double depth) {
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(roller(named("left"), 0));
  model.boundary.push_back(roller(named("front"), 1));
  for (const char* side : {"right", "back", "top"}) model.boundary.push_back(moved(named(side), 3));
  Sphere sphere;
  sphere.radius = radius;
  sphere.centre = {0.0, 0.0, depth - radius};
  sphere.direction = Vector3{0.0, 0.0, -1.0};
  model.contact.push_back({box({0, 0, 0}, {HalfSpace::fine, HalfSpace::fine, 0}), sphere, std::nullopt});
  return model;
}

/// Builds the problem, lets `change` modify what a case file cannot express (values that vary from node to
/// node), and solves it.
inline Run run_changed(Mesh mesh, const Model& model, const std::function<void(Problem&)>& change) {
  Run run;
  run.problem = build_problem(std::move(mesh), model);
  change(run.problem);
  run.part = distribute(&run.problem, MPI_COMM_SELF);
  run.solution = solve(run.part, model.solver, {});
  return run;
}

inline const double* node_of(const Run& run, std::size_t point) {
  return &run.part.coordinates[static_cast<std::size_t>(run.part.contact[point].node) *
                               static_cast<std::size_t>(run.part.dim())];
}

}  // namespace kacanov::testing
