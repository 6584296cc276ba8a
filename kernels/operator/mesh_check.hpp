// SPDX-License-Identifier: BSD-3-Clause
// Tests arrays that come from outside before a kernel trusts them.
#pragma once

#include <cstddef>
#include <string>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// What is wrong with the mesh, in words that name the first node or element at fault (from 0); empty if
/// nothing: no node, no element, a length that is no multiple, a coordinate that is not finite, an index out
/// of range, or an element whose map is not orientation-preserving at every quadrature point, or folded
/// anywhere.
std::string mesh_fault(const MeshView& mesh);

/// The same without the elements' shapes: what has to be right before anybody reads the arrays.
std::string arrays_fault(const MeshView& mesh);

/// Whether the element's map turns the wrong way round at every quadrature point. Indices have been checked.
bool is_inverted(const MeshView& mesh, std::size_t element);

}  // namespace kacanov
