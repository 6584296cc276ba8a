// SPDX-License-Identifier: BSD-3-Clause
// The problem that a case defines on its mesh: loads, supports, laws, contact rows.
#pragma once

#include <map>
#include <utility>

#include "verify/law.hpp"
#include "verify/load_point.hpp"
#include "verify/mesh.hpp"

namespace kacanov::verify {

/// Rows of a contact point (theory: traces): N·u ≤ gap; T·u is the part of u that is free and orthogonal to
/// the normal.
struct ContactRow {
  struct Share {
    Index node = 0;
    Vec normal{};  ///< coefficients of N in free components
  };
  std::vector<Share> shares;
  Index node = 0;                    ///< node of the row in contact.vtu
  std::vector<std::size_t> written;  ///< indices into contact.vtu: one per entry that contributes
  std::vector<std::pair<std::size_t, Real>> parts;  ///< contributing entries, and the mass of each
  Vec normal{};                                     ///< ν
  std::size_t entry = 0;                            ///< index into `contact`
  Real gap = 0, mass = 0, tresca = 0, coulomb = 0;
  Real closed = 0;       ///< part of the gap closed by prescribed components
  Real unknown_gap = 0;  ///< round-off of the gap
  Vec slip_origin{};     ///< displacement from which slip is counted (theory: slip-history, moving-obstacles)
  bool friction = false;
  bool since_step = false;  ///< slip_origin includes the displacement at the end of the previous load step
  bool alone = false;       ///< rows of a moving obstacle are never joined
  bool grazing = false;     ///< round-off decides whether the obstacle is hit
};

/// Prescribed displacement along a unit vector.
struct GivenDirection {
  Vec direction{};
  Real value = 0;
  std::size_t entry = 0;  ///< index into `boundary`
  Real condition = 1;     ///< factor on round-off if other directions of the node are nearly parallel
};

/// Direction and value of a boundary entry before orthogonalisation against others of its node.
struct GivenSupport {
  Vec direction{};
  std::size_t entry = 0;
  Real value = 0, largest = 0;  ///< `largest`: value at the largest factor of the load curve
  bool axis = false;            ///< prescribed as a component
  Real condition = 1;           ///< its round-off relative to that of long double
  bool dependent = false;       ///< already determined by other supports of the node
};

/// Stress per constrained in-plane strain of an elastic body in plane stress: E/(1 − ν).
Real expansion_stress(const Law& law);

/// A spring between a node and the ground.
struct Spring {
  Index node = 0;
  std::size_t entry = 0;
  std::array<Vec, 3> stiffness{};
};

/// Resultant force and moment about the origin; `size` and `arms` sum the magnitudes of their terms, `nodes`
/// counts the nodes.
struct Resultant {
  Vec force{}, moment{};
  Real size = 0, arms = 0, nodes = 0;
};

struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::size_t> law_of_element;
  std::vector<Vec> load;            ///< F, one per node
  std::vector<std::int64_t> patch;  ///< patch of each node, if the result has patches; else empty
  std::vector<Real> free_strain;    ///< α ΔT of each element in plane stress; empty: none
  /// Pressure of constrained thermal expansion at the stiffness quadrature points, per element; empty: no
  /// temperature change.
  std::vector<std::vector<Real>> expansion;
  std::vector<std::array<bool, 3>> held;  ///< components with a prescribed displacement
  std::vector<Vec> prescribed;
  std::map<Index, std::vector<GivenSupport>> supports;  ///< by node, in the order of the entries
  /// Prescribed directions that are not axes, by node: orthonormal, in free components (theory:
  /// held-directions).
  std::map<Index, std::vector<GivenDirection>> directions;
  std::vector<std::array<Vec, 3>> springs;  ///< stiffness between each node and the ground; empty: none
  std::vector<Spring> each_spring;          ///< the same, one by one
  std::vector<Resultant> applied;           ///< loads of each boundary entry
  std::vector<Real> contact_factor;         ///< of each contact entry
  Real time = 1;                            ///< reached by the state: time of the load curves, or load factor
  LoadPoint point;
  std::vector<ContactRow> rows;
  std::vector<std::int64_t> surface_tags;  ///< node numbers in contact.vtu, in its order
  std::vector<Vec> probes;
  Real tolerance = 1e-6L;
};

/// Reads a case that the program has accepted, at the end of a load step; throws Failure for unsupported
/// features. `folder`: where relative paths start. find_rows() adds the contact rows.
Problem read_problem(const nlohmann::json& document, const std::filesystem::path& folder,
                     const LoadPoint& point);

/// Load factor of an entry, and the largest one of its load curve.
struct Factor {
  Real value = 1, largest = 1;
};
/// Applies an entry with prescribed displacement, by component or along directions, to its nodes.
void hold(Problem& problem, const nlohmann::json& entry, std::size_t number, const Factor& factor);
/// Call it after hold() for all entries: orthogonalises the directions of each node against its other
/// supports.
void find_directions(Problem& problem);
/// Returns the distance of a node from its prescribed position beyond round-off (theory: support-rounding).
/// `most`: the largest displacement.
Real off_supports(const std::vector<GivenSupport>& supports, const Vec& u, Real most);
/// Returns the part of `v` in the free directions of a node.
Vec free_part(const Problem& problem, Index node, Vec v);

/// Finds the contact rows of a problem whose supports and load point are set.
void find_rows(const nlohmann::json& contact, const std::filesystem::path& folder, Problem& problem);

/// ∫ Nᵢ dS and ∫ Nᵢ n dS of a facet, one per node (theory: loads).
struct FacetIntegrals {
  std::vector<Real> area;
  std::vector<Vec> normal;
};
FacetIntegrals consistent(const Mesh& mesh, const Indices& facet);
/// Lumped masses and normals of a facet's nodes: the quadrature that turns multipliers and elastic
/// foundations into forces. On six-node facets only the mid-side nodes have weight.
FacetIntegrals contact_weights(const Mesh& mesh, const Indices& facet);
/// Outward normal at a point, scaled by the area relative to the reference cell.
Vec normal_at(const Mesh& mesh, const Indices& facet, const Functions& at);

Vec read_vector(const nlohmann::json& list);
/// Adds a force at a point; `size`: magnitude of its terms.
void add_force(Resultant& sum, const Vec& at, const Vec& force, Real size);

}  // namespace kacanov::verify
