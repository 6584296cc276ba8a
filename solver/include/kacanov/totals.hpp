// SPDX-License-Identifier: BSD-3-Clause
// What the entries of a model and the whole body come to: forces, moments, extremes and their places.
#pragma once

#include <cstdint>

#include <kacanov/model.hpp>

namespace kacanov {

/// Force and moment about the origin, both of nodal forces at undeformed nodes. In 2D, for the model's
/// thickness, the moment has its third entry alone.
struct Resultant {
  Vector3 force{}, moment{};
};

/// What one contact entry does to the body (theory: entry-totals).
struct ContactTotals {
  std::int32_t entry = 0;  ///< index into Model::contact
  Resultant total;         ///< normal and friction together
  Vector3 normal_force{}, friction_force{};
  double area = 0.0;          ///< lumped, of the nodes under pressure (in 2D length times thickness)
  double max_pressure = 0.0;  ///< at a node
  double least_gap = 0.0;     ///< open distance that is left; negative by what the tolerance allows
  double travel = 0.0;        ///< how far an obstacle that is pushed has moved along its direction
  double first_gap = 0.0;     ///< the least open distance at rest
  /// Nodes under pressure that hold on to the obstacle, those that do not (all without friction), and nodes
  /// without pressure. A node of two entries counts in both.
  std::int64_t sticking = 0, slipping = 0, open = 0;
  double open_friction = 0.0;  ///< of Σ M|λ_t|, the share at nodes without pressure: Tresca's acts there too
};

/// What one boundary entry does to the body: a support by its reactions, a load by itself, times its factor.
struct BoundaryTotals {
  std::int32_t entry = 0;  ///< index into Model::boundary
  Resultant total;
};

/// A largest value, and where it is.
struct Extreme {
  double value = 0.0;
  Vector3 at{};          ///< the undeformed node, or the mean of an element's nodes
  std::int64_t tag = 0;  ///< the mesh file's number of that node or element
};

/// The undeformed body.
struct BodySize {
  int dim = 3;
  Vector3 lower{}, upper{};  ///< of the smallest box round it
  double size = 0.0;         ///< that box's diagonal
  double volume = 0.0;       ///< in 2D area times thickness
};

}  // namespace kacanov
