// SPDX-License-Identifier: BSD-3-Clause
// A non-owning view of a mesh: the geometry that the kernels read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <kacanov/cells.hpp>

namespace kacanov {

/// Plane state of a 2D mesh (theory: plane-stress, axisymmetry). An axisymmetric mesh is a section x ≥ 0,
/// where x is the distance from the axis and y runs along it; volumes and forces are those of the full
/// circle.
enum class PlaneState : std::uint8_t { strain, stress, axisymmetric };

/// Arrays of the caller, which must outlive the view. Elements must be positively oriented (det ∂x/∂ξ > 0).
struct MeshView {
  ElementType type = ElementType::tet4;
  std::span<const double> coordinates;         ///< nodes × dim, interleaved
  std::span<const std::int32_t> connectivity;  ///< elements × nodes_per_element, from 0; Gmsh's order
  PlaneState plane = PlaneState::strain;       ///< ignored in 3D

  std::size_t node_count() const { return coordinates.size() / dimension(type); }
  std::size_t element_count() const { return connectivity.size() / nodes_per_element(type); }
};

}  // namespace kacanov
