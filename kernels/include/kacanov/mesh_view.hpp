// SPDX-License-Identifier: BSD-3-Clause
// A non-owning view of a mesh: what the kernels know of geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <kacanov/cells.hpp>

namespace kacanov {

/// What a mesh in 2D is of (theory: plane-stress, axisymmetry). Axisymmetric meshes are sections x ≥ 0, x the
/// distance from the axis and y along it; volumes and forces are those of the full circle.
enum class PlaneState : std::uint8_t { strain, stress, axisymmetric };

/// Arrays of the caller, which must outlive the view. Elements are positively oriented (det ∂x/∂ξ > 0).
struct MeshView {
  ElementType type = ElementType::tet4;
  std::span<const double> coordinates;         ///< nodes × dim, interleaved
  std::span<const std::int32_t> connectivity;  ///< elements × nodes_per_element, from 0; Gmsh's order
  PlaneState plane = PlaneState::strain;       ///< no matter in 3D

  std::size_t node_count() const { return coordinates.size() / dimension(type); }
  std::size_t element_count() const { return connectivity.size() / nodes_per_element(type); }
};

}  // namespace kacanov
