// SPDX-License-Identifier: BSD-3-Clause
// What the maps from the reference element to the elements of a mesh do at their quadrature points.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// Of one element. det J is that of ∂x/∂ξ.
struct ElementMap {
  double volume = 0.0;  ///< Σ w det J, signed: in the plane an area
  double least_det = 0.0, most_det = 0.0;
  /// Least over largest stretch at the worst point, within a factor of 3: d/(‖J‖ ‖J⁻¹‖) in Frobenius norms, d
  /// the dimension. 1 for a cube, 0 for a flat element, negative for an inverted one, whatever its size; 0
  /// where numbers overflow.
  double thinness = 1.0;
};

/// Indices have been checked. The plain version: any type.
ElementMap element_map(const MeshView& mesh, std::size_t element);

/// All elements' maps, in order, some at a time: visit(first, maps). Those in space are worked out abreast,
/// 60 ns a hex8 against 300.
void visit_element_maps(const MeshView& mesh,
                        const std::function<void(std::size_t, std::span<const ElementMap>)>& visit);

}  // namespace kacanov
