// SPDX-License-Identifier: BSD-3-Clause
// Whether the Jacobian determinant of an element is positive all over it, by its Bézier coefficients.
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

/// Finds one in an element whose map is not affine; nothing where det J ≥ 0 all over, up to the rounding of
/// coordinates in files (theory: folded-elements). Indices have been checked, coordinates are finite.
std::optional<NegativeJacobian> find_negative_jacobian(const MeshView& mesh, std::size_t element);

}  // namespace kacanov
