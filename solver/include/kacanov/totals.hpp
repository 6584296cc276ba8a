// SPDX-License-Identifier: BSD-3-Clause
// Totals per model entry and of the whole body: forces, moments, extreme values and their positions.
#pragma once

#include <cstdint>

#include <kacanov/model.hpp>

namespace kacanov {

/// Force and moment about the origin of nodal forces at the undeformed nodes. In 2D both refer to the model's
/// thickness, and the moment has only its third component.
struct Resultant {
  Vector3 force{}, moment{};
};

/// Forces of one contact entry on the body, and its contact state (theory: entry-totals).
struct ContactTotals {
  std::int32_t entry = 0;  ///< index into Model::contact
  Resultant total;         ///< normal and friction forces
  Vector3 normal_force{}, friction_force{};
  double area = 0.0;          ///< lumped area of the nodes under pressure (in 2D length times thickness)
  double max_pressure = 0.0;  ///< at a node
  double least_gap = 0.0;     ///< smallest open distance; negative: penetration within the tolerance
  double travel = 0.0;        ///< displacement of a force-controlled obstacle along its direction
  double first_gap = 0.0;     ///< smallest open distance at rest
  /// Numbers of nodes under pressure that stick, of those that slip (all without friction), and of nodes
  /// without pressure. A node of two entries counts in both.
  std::int64_t sticking = 0, slipping = 0, open = 0;
  /// Share of Σ M|λ_t| at nodes without pressure, where Tresca friction also acts.
  double open_friction = 0.0;
};

/// Forces of one boundary entry on the body: the reactions of a support, or a load times its factor.
struct BoundaryTotals {
  std::int32_t entry = 0;  ///< index into Model::boundary
  Resultant total;
};

/// A maximum and its position.
struct Extreme {
  double value = 0.0;
  Vector3 at{};          ///< the undeformed node, or the mean of the element's nodes
  std::int64_t tag = 0;  ///< number of that node or element in the mesh file
};

/// The undeformed body.
struct BodySize {
  int dim = 3;
  Vector3 lower{}, upper{};  ///< of the bounding box
  double size = 0.0;         ///< diagonal of the bounding box
  double volume = 0.0;       ///< in 2D area times thickness
};

}  // namespace kacanov
