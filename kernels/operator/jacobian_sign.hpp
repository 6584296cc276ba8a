// SPDX-License-Identifier: BSD-3-Clause
// Checks by Bézier coefficients whether det J is positive in the whole element.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// A point of the reference element where det J is negative.
struct NegativeJacobian {
  double det = 0.0;
  std::size_t nearest_corner = 0;
};

/// Returns such a point for an element whose map is not affine; empty if det J ≥ 0 everywhere, up to the
/// rounding of coordinates in files (theory: folded-elements). Indices must have been checked, coordinates
/// must be finite.
std::optional<NegativeJacobian> find_negative_jacobian(const MeshView& mesh, std::size_t element);

}  // namespace kacanov
