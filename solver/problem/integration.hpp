// SPDX-License-Identifier: BSD-3-Clause
// Integrals of shape functions over facets and elements: what loads and contact masses are made of.
#pragma once

#include <array>
#include <span>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

// Of axisymmetric meshes integrals go all round the axis (theory: axisymmetry), and those of ∇N are the
// volume change of unit displacements.

/// One entry a node of a facet, in the facet's order; the rest is unused.
struct FacetWeights {
  std::array<double, most_facet_nodes> area{};     ///< ∫ Nᵢ dS (a length in 2D)
  std::array<Vector3, most_facet_nodes> normal{};  ///< ∫ Nᵢ n dS, n the outer normal
};

/// Consistent weights: exact for planar facets, and for `normal` on curved ones too.
FacetWeights consistent_weights(const Mesh& mesh, std::size_t facet);

/// Weights of the lumped contact mass (theory: contact-mass). For linear facets they are the consistent ones;
/// of the six-node triangle the mid-sides have a third each, as in the consistent load, and the corners none.
FacetWeights lumped_weights(const Mesh& mesh, std::size_t facet);

/// ∫ f ∇Nᵢ dV by the points of the stiffness, one entry a node of the element; f is linear between its values
/// at the corners, 1 where there are none.
std::array<Vector3, most_nodes> gradient_weights(const Mesh& mesh, std::size_t element,
                                                 std::span<const double> at_corners = {});

/// The mean of f over the element by the same points.
double mean_by_points(const Mesh& mesh, std::size_t element, std::span<const double> at_corners);

/// ∫ Nᵢ dV (an area in 2D), one entry a node of the element.
std::array<double, most_nodes> volume_weights(const Mesh& mesh, std::size_t element);

}  // namespace kacanov
