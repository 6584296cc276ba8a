// SPDX-License-Identifier: BSD-3-Clause
// Generated meshes for benchmarks and tests: boxes of every element type, perturbed and irregular ones.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <kacanov/mesh_view.hpp>

namespace kacanov::meshes {

struct OwnedMesh {
  ElementType type = ElementType::tet4;
  std::vector<double> coordinates;         ///< nodes × dim
  std::vector<std::int32_t> connectivity;  ///< elements × nodes per element

  MeshView view() const noexcept { return {type, coordinates, connectivity}; }
};

/// Returns a box of `cells` cubes (squares in 2D, third entry ignored), each cut as by Cell::box. Quadratic
/// elements have straight sides.
OwnedMesh box(ElementType type, std::array<int, 3> cells, std::array<double, 3> size);

/// Moves every node, mid-side nodes too, by up to `amount` times the smallest extent of an element along each
/// axis.
void jitter(OwnedMesh& mesh, double amount, unsigned seed);

/// Moves the mid-side nodes, if any, halfway between their vertices.
void straighten(OwnedMesh& mesh);

/// Applies random 2–3 and 3–2 flips to a tet4 mesh, which give it the connectivity of an unstructured mesh,
/// in `rounds` sweeps over the elements; every tetrahedron keeps a positive volume.
void flip(OwnedMesh& mesh, int rounds, unsigned seed);

/// Shuffles nodes and elements: the worst numbering that a caller can have.
void shuffle(OwnedMesh& mesh, unsigned seed);

}  // namespace kacanov::meshes
