// SPDX-License-Identifier: BSD-3-Clause
// Integrals of shape functions over facets and elements, for loads and contact mass.
#pragma once

#include <array>
#include <span>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

// On axisymmetric meshes all integrals cover the full revolution (theory: axisymmetry), and those of ∇N are
// the volume change of unit displacements.

/// One entry per node of a facet, in the facet's order; the other entries are unused.
struct FacetWeights {
  std::array<double, most_facet_nodes> area{};     ///< ∫ Nᵢ dS (a length in 2D)
  std::array<Vector3, most_facet_nodes> normal{};  ///< ∫ Nᵢ n dS, n the outer normal
};

/// Returns consistent weights: exact for planar facets, and for `normal` also on curved facets.
FacetWeights consistent_weights(const Mesh& mesh, std::size_t facet);

/// Returns the weights of the lumped contact mass (theory: contact-mass): the consistent ones for linear
/// facets; for the six-node triangle a third of the area at each mid-side node and none at the corners, as in
/// the consistent load.
FacetWeights lumped_weights(const Mesh& mesh, std::size_t facet);

/// Returns ∫ f ∇Nᵢ dV with the quadrature points of the stiffness, one entry per node of the element. f is
/// linear between its values at the corners, and 1 if none are given.
std::array<Vector3, most_nodes> gradient_weights(const Mesh& mesh, std::size_t element,
                                                 std::span<const double> at_corners = {});

/// Returns the mean of f over the element with the same quadrature points.
double mean_by_points(const Mesh& mesh, std::size_t element, std::span<const double> at_corners);

/// Returns ∫ Nᵢ dV (an area in 2D), one entry per node of the element.
std::array<double, most_nodes> volume_weights(const Mesh& mesh, std::size_t element);

}  // namespace kacanov
