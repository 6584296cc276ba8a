// SPDX-License-Identifier: BSD-3-Clause
// Reference operator: one plain loop per element, which the tests compare the fast operators with.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <kacanov/law.hpp>
#include <kacanov/mesh_view.hpp>

namespace kacanov {

/// Values of a law at the quadrature points for some displacement, computed by the caller: elements × points,
/// the points of an element contiguous. Arrays that a function does not need may be empty.
struct PointModuli {
  std::span<const double> secant;           ///< g
  std::span<const double> derivative = {};  ///< dg/dx
  std::span<const double> energy = {};      ///< G(x) = ∫₀ˣ g(s) s ds
};

/// A meshed body and its material. It owns nothing: the arrays must outlive it. It checks nothing: the
/// operators' constructors do.
struct Body {
  MeshView mesh;
  std::span<const Law> laws;                      ///< at least one
  std::span<const std::uint16_t> law_of_element;  ///< one entry per element; empty: laws[0] everywhere
  /// Used instead of the laws' values at the given displacement; the laws still provide k0. Only the
  /// reference functions of a displacement read it; operators ignore it. Null: the laws are used.
  const PointModuli* moduli = nullptr;
  /// Plane stress: stress-free strain of each element, equal in all directions. The reference functions of a
  /// displacement read it; operators get it from BasicOperator::set_free_strain(). Empty: zero (theory:
  /// expansion).
  std::span<const double> free_strain = {};
  /// Averages of tr ε around the corners (CornerMeans) at the given displacement, elements × 4, for elements
  /// that are part of a larger body. Only the reference functions of a displacement read it. Empty: computed
  /// from these elements.
  std::span<const double> corner_dilatation = {};
  /// Patch number of each node: where laws average around corners, the nodes of a patch share one average of
  /// tr ε. The number is the global number of one of the patch's nodes, the same on all ranks
  /// (pressure_patches() computes it). Empty: every node has its own average.
  std::span<const std::int64_t> pressure_patch = {};

  std::size_t unknowns() const noexcept { return mesh.coordinates.size(); }
  std::uint16_t law_index(std::size_t element) const noexcept {
    return law_of_element.empty() ? std::uint16_t{0} : law_of_element[element];
  }
  const Law& law(std::size_t element) const noexcept { return laws[law_index(element)]; }
  std::size_t secant_count() const { return mesh.element_count() * points_per_element(mesh.type); }
};

/// theory: operator. Vectors (u, x, y, f, d) have nodes × dim entries, interleaved; g has elements × points
/// entries, the points of an element contiguous. The caller must have checked lengths, indices and laws.
/// Displacements have the caller's unit of length, g the unit of stress, forces stress times area: in 2D
/// stress times length, for unit thickness; in axisymmetric meshes the force over the full circle.
namespace reference {

/// Computes g of the law at u.
void secant(const Body& body, std::span<const double> u, std::span<double> g);
/// y = B(g) x (overwrites y).
void apply(const Body& body, std::span<const double> g, std::span<const double> x, std::span<double> y);
/// y = B_T(u) x, the consistent tangent 2g I_dev + (2g'/x) dev ε ⊗ dev ε of the law at u.
void apply_tangent(const Body& body, std::span<const double> u, std::span<const double> x,
                   std::span<double> y);
/// Diagonal of B(g). Where tr ε is averaged around corners: the diagonal with tr ε at the points instead, an
/// upper bound.
void diagonal(const Body& body, std::span<const double> g, std::span<double> d);
/// dim × dim diagonal blocks of B(g), nodes × dim × dim, row-major; the same bound as in diagonal().
void block_diagonal(const Body& body, std::span<const double> g, std::span<double> blocks);
/// dim × dim diagonal blocks of B_T(u), laid out as those of B(g).
void block_diagonal_tangent(const Body& body, std::span<const double> u, std::span<double> blocks);
/// Internal force of the true nonlinear law at u (overwrites f).
void residual(const Body& body, std::span<const double> u, std::span<double> f);
/// Nodal forces of the elastic body if its free strain were an elastic strain (overwrites f). Returns the
/// energy of that strain.
double free_force(const Body& body, std::span<double> f);
/// Nodal forces ∫ p div v of a pressure (overwrites f): one value per element, or 1 + corners of them, of
/// which only those at the corners are used, with linear interpolation (theory: expansion). Returns the
/// energy that the elastic body stores if it cannot expand.
double expansion_force(const Body& body, std::span<const double> pressure, std::span<double> f);
/// Stored energy ∫ k0/2 tr² + 2 G(x) at u.
double energy(const Body& body, std::span<const double> u);
/// residual() and energy() in one pass over the elements; returns the energy.
double response(const Body& body, std::span<const double> u, std::span<double> f);
/// Stiffness of one element for frozen g, with tr ε at the element's own points even where it is averaged
/// around corners. `matrix`: (nodes·dim)² entries, row-major, the components of a node contiguous.
void element_matrix(const Body& body, std::size_t element, std::span<const double> g,
                    std::span<double> matrix);
/// Tangent stiffness of one element at u, a vector of the whole body; `matrix` as in element_matrix().
void element_tangent(const Body& body, std::size_t element, std::span<const double> u,
                     std::span<double> matrix);
/// Displacements and pressures, or forces and volume changes. `u` has nodes × dim entries, interleaved, `p`
/// one per node; entries of p at mid-side nodes are unused.
template <class Real>
struct DisplacementPressure {
  std::span<Real> u, p;
};
/// y = K(g) x with K = [A Bᵀ; B −C] (theory: displacement-pressure; overwrites y, with 0 for p at mid-side
/// nodes): A is the deviatoric part of the operator, B the volume change at every corner, C the lumped
/// mass/k0 and, for linear displacements, the stabilisation. p is the mean stress k0 tr ε, in the unit of g;
/// `g` as in `apply`. Throws std::invalid_argument for elements that are not simplices.
void apply_mixed(const Body& body, std::span<const double> g, const DisplacementPressure<const double>& x,
                 const DisplacementPressure<double>& y);
/// Volumes (areas in 2D) of the elements, one entry per element; not positive for inverted or degenerate
/// elements.
void volumes(const Body& body, std::span<double> volume);

/// Element results for plots, output files and summaries: averages over the element's points, or maxima over
/// them.
struct ElementFields {
  std::span<double> stress;         ///< elements × 6: xx yy zz xy yz zx (zz also in 2D)
  std::span<double> von_mises;      ///< elements
  std::span<double> dev_strain;     ///< elements: ‖dev ε‖
  std::span<double> secant;         ///< elements: g
  std::span<std::uint8_t> plastic;  ///< elements: 1 if any point is beyond yield
  std::span<double> strain = {};    ///< elements: largest magnitude of a principal strain over the points
  std::span<double> rotation = {};  ///< elements: largest rotation angle over the points, radians
  std::span<double> volume = {};    ///< elements: undeformed, as from volumes()
};
/// Fills the spans that are not empty.
void fields(const Body& body, std::span<const double> u, const ElementFields& out);

/// Results at the quadrature points: elements × points, the points of an element contiguous.
struct PointFields {
  std::span<std::array<double, 3>> position;  ///< undeformed; the third entry is 0 in 2D
  std::span<double> stress;                   ///< × 6, as in ElementFields
  std::span<double> strain;  ///< × 6, tensor components in the same order, with the B-bar trace
  std::span<double> volume;  ///< quadrature weight in the undeformed body
};
/// Fills the spans that are not empty.
void point_fields(const Body& body, std::span<const double> u, const PointFields& out);

/// Small strain at the points: × 6, tensor components (not engineering shears) xx yy zz xy yz zx. The trace
/// is the element's average where its law has mean_dilatation.
void strains(const Body& body, std::span<const double> u, std::span<double> strain);
/// Positions of the points, × dim, and their weights, which sum to the element's volume (area in 2D). Empty
/// spans are skipped.
void points(const Body& body, std::span<double> position, std::span<double> weight);

}  // namespace reference
}  // namespace kacanov
