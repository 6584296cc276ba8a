// SPDX-License-Identifier: BSD-3-Clause
// Input checks of the operators and of mesh arrays from outside, in either precision.
#pragma once

#include <cstddef>
#include <string>

#include <kacanov/mesh_view.hpp>
#include <kacanov/operator.hpp>

namespace kacanov {

/// Returns an error message that names the first invalid node or element (from 0); empty if the mesh is
/// valid. Errors: no node, no element, an incorrect array length, a coordinate that is not finite, an index
/// out of range, an element that is inverted or degenerate at a quadrature point, or folded anywhere.
std::string mesh_fault(const MeshView& mesh);

/// The same without the elements' shapes: the conditions for reading the arrays at all.
std::string arrays_fault(const MeshView& mesh);

/// Returns whether det J is negative at every quadrature point. Indices must have been checked.
bool is_inverted(const MeshView& mesh, std::size_t element);

/// Throws std::invalid_argument, with the name `what`, unless `actual` equals `wanted`.
void expect_size(std::size_t actual, std::size_t wanted, const char* what);

/// Returns the body, or throws std::invalid_argument with the error in it or in the options.
const Body& checked(const Body& body, const OperatorOptions& options);

/// The checks that do not concern the mesh.
void check_options(const Body& body, const OperatorOptions& options);
void check_laws(const Body& body);

}  // namespace kacanov
