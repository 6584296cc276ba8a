// SPDX-License-Identifier: BSD-3-Clause
// Maps from the reference element to mesh elements: their properties at the quadrature points, and whether
// det J is positive in the whole element.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// Properties of one element; det J is the determinant of ∂x/∂ξ.
struct ElementMap {
  double volume = 0.0;  ///< Σ w det J, signed; in 2D an area
  double least_det = 0.0, most_det = 0.0;
  /// Ratio of the smallest to the largest stretch at the worst point, within a factor of 3: d/(‖J‖ ‖J⁻¹‖) in
  /// Frobenius norms, d the dimension. 1 for a cube, 0 for a flat element, negative for an inverted one,
  /// whatever its size; 0 on overflow.
  double thinness = 1.0;
};

/// Plain version for any type. Indices must have been checked.
ElementMap element_map(const MeshView& mesh, std::size_t element);

/// Calls visit(first, maps) for the maps of all elements, in order, several per call. 3D elements are
/// vectorised: 60 ns per hex8 instead of 300.
void visit_element_maps(const MeshView& mesh,
                        const std::function<void(std::size_t, std::span<const ElementMap>)>& visit);

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
