// SPDX-License-Identifier: BSD-3-Clause
// Checks of mesh arrays from outside before a kernel uses them.
#pragma once

#include <cstddef>
#include <string>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// Returns an error message that names the first invalid node or element (from 0); empty if the mesh is
/// valid. Errors: no node, no element, an incorrect array length, a coordinate that is not finite, an index
/// out of range, an element that is inverted or degenerate at a quadrature point, or folded anywhere.
std::string mesh_fault(const MeshView& mesh);

/// The same without the elements' shapes: the conditions for reading the arrays at all.
std::string arrays_fault(const MeshView& mesh);

/// Returns whether det J is negative at every quadrature point. Indices must have been checked.
bool is_inverted(const MeshView& mesh, std::size_t element);

}  // namespace kacanov
