// SPDX-License-Identifier: BSD-3-Clause
// The operator as one plain loop an element: the truth the fast ones are tested against.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <kacanov/law.hpp>
#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// What laws say at the points at some displacement, worked out by the caller: elements × points, the points
/// of an element together. What is not asked for may be empty.
struct PointModuli {
  std::span<const double> secant;           ///< g
  std::span<const double> derivative = {};  ///< dg/dx
  std::span<const double> energy = {};      ///< G(x) = ∫₀ˣ g(s) s ds
};

/// A meshed body and its material. Nothing is owned: the arrays must outlive it. Nothing is checked either:
/// the operators' constructors do that.
struct Body {
  MeshView mesh;
  std::span<const Law> laws;                      ///< at least one
  std::span<const std::uint16_t> law_of_element;  ///< one entry an element; empty: laws[0] everywhere
  /// In place of what the laws say at the displacement asked for; they leave their k0. The reference's
  /// functions of a displacement know of it, operators do not. Null: the laws.
  const PointModuli* moduli = nullptr;
  /// Plane stress: by how much each element is longer in all directions where nothing acts on it; the
  /// reference's functions of a displacement know of it, operators by BasicOperator::set_free_strain().
  /// Empty: by nothing (theory: expansion).
  std::span<const double> free_strain = {};
  /// Means of tr ε round the corners (CornerMeans) at the displacement asked for, elements × 4, where these
  /// elements are some of a larger body; the reference's functions of a displacement know of it. Empty:
  /// worked out from these elements.
  std::span<const double> corner_dilatation = {};
  /// Nodes of one number have one mean of tr ε together where laws average round corners; it is the number
  /// over all processes of one of them, on all the same (pressure_patches() makes some). Empty: every node
  /// has a mean of its own.
  std::span<const std::int64_t> pressure_patch = {};

  std::size_t unknowns() const noexcept { return mesh.coordinates.size(); }
  std::uint16_t law_index(std::size_t element) const noexcept {
    return law_of_element.empty() ? std::uint16_t{0} : law_of_element[element];
  }
  const Law& law(std::size_t element) const noexcept { return laws[law_index(element)]; }
  std::size_t secant_count() const { return mesh.element_count() * points_per_element(mesh.type); }
};

/// theory: operator. Vectors (u, x, y, f, d) have nodes × dim entries, interleaved; g has elements × points,
/// the points of an element together. Lengths, indices and laws are taken as they are: whoever calls has
/// checked them. Displacements have the caller's unit of length, g that of stress, forces stress times area
/// (in 2D stress times length, for unit thickness; all
/// round of axisymmetric meshes).
namespace reference {

/// g of the law at u.
void secant(const Body& body, std::span<const double> u, std::span<double> g);
/// y = B(g) x (overwrites y).
void apply(const Body& body, std::span<const double> g, std::span<const double> x, std::span<double> y);
/// y = B_T(u) x, the consistent tangent 2g I_dev + (2g'/x) dev ε ⊗ dev ε of the law at u.
void apply_tangent(const Body& body, std::span<const double> u, std::span<const double> x,
                   std::span<double> y);
/// Diagonal of B(g); where tr ε is averaged round corners, that of its values at the points, which is no
/// less.
void diagonal(const Body& body, std::span<const double> g, std::span<double> d);
/// dim × dim diagonal blocks of B(g), nodes × dim × dim, row-major; likewise.
void block_diagonal(const Body& body, std::span<const double> g, std::span<double> blocks);
/// dim × dim diagonal blocks of B_T(u), as those of B(g).
void block_diagonal_tangent(const Body& body, std::span<const double> u, std::span<double> blocks);
/// Internal force of the true nonlinear law at u (overwrites f).
void residual(const Body& body, std::span<const double> u, std::span<double> f);
/// What the elastic body would push its nodes with if its free strain were a strain (overwrites f). Returns
/// the energy it would store.
double free_force(const Body& body, std::span<double> f);
/// Stored energy ∫ k0/2 tr² + 2 G(x) at u.
double energy(const Body& body, std::span<const double> u);
/// residual() and energy() on one walk over the elements.
double response(const Body& body, std::span<const double> u, std::span<double> f);
/// Stiffness of one element for frozen g (its own points only, tr ε at them even where it is averaged round
/// corners): `matrix` has (nodes·dim)² entries, row-major, with the components of a node together.
void element_matrix(const Body& body, std::size_t element, std::span<const double> g,
                    std::span<double> matrix);
/// Tangent stiffness of one element at u, a vector of the whole body; `matrix` as above.
void element_tangent(const Body& body, std::size_t element, std::span<const double> u,
                     std::span<double> matrix);
/// Volumes (areas in 2D) of the elements, one entry each; not positive for inverted or degenerate ones.
void volumes(const Body& body, std::span<double> volume);

/// What a picture, an output file or a summary wants to know of an element: means over its points, or the
/// largest value of any point.
struct ElementFields {
  std::span<double> stress;         ///< elements × 6: xx yy zz xy yz zx (zz also in 2D)
  std::span<double> von_mises;      ///< elements
  std::span<double> dev_strain;     ///< elements: ‖dev ε‖
  std::span<double> secant;         ///< elements: g
  std::span<std::uint8_t> plastic;  ///< elements: 1 if any point is beyond yield
  std::span<double> strain = {};    ///< elements: the largest principal strain of any point, or its opposite
  std::span<double> rotation = {};  ///< elements: the largest angle of rotation of any point, radians
  std::span<double> volume = {};    ///< elements: undeformed, as volumes() has it
};
/// Fills the spans that are not empty.
void fields(const Body& body, std::span<const double> u, const ElementFields& out);

/// What the quadrature points have: elements × points, an element's together.
struct PointFields {
  std::span<std::array<double, 3>> position;  ///< undeformed; the third entry is 0 in 2D
  std::span<double> stress;                   ///< × 6, as in ElementFields
  std::span<double> strain;  ///< × 6, tensor components in the same order, with B-bar's trace
  std::span<double> volume;  ///< quadrature weight, of the undeformed body
};
/// Fills the spans that are not empty.
void point_fields(const Body& body, std::span<const double> u, const PointFields& out);

/// Small strain at the points: × 6, components (not engineering shears) xx yy zz xy yz zx; the trace is the
/// element's mean where its law says so.
void strains(const Body& body, std::span<const double> u, std::span<double> strain);
/// Positions of the points, × dim, and their weights: what of the element's volume (area in 2D) belongs to
/// each. Spans that are empty are left out.
void points(const Body& body, std::span<double> position, std::span<double> weight);

}  // namespace reference
}  // namespace kacanov
