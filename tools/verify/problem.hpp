// SPDX-License-Identifier: BSD-3-Clause
// What a case asks for on its mesh: loads, supports, laws, contact rows.
#pragma once

#include <map>

#include "verify/law.hpp"
#include "verify/load_point.hpp"
#include "verify/mesh.hpp"

namespace kacanov::verify {

/// Rows of a contact point (theory: traces): N·u ≤ gap, T·u the part of u that is free and orthogonal to it.
struct ContactRow {
  struct Share {
    Index node = 0;
    Vec normal{};  ///< coefficients of N in free components
  };
  std::vector<Share> shares;
  Index node = 0;                    ///< that it stands for in contact.vtu
  std::vector<std::size_t> written;  ///< its places in contact.vtu: one an entry that has a part in it
  Vec normal{};                      ///< ν
  std::size_t entry = 0;             ///< of `contact`
  Real gap = 0, mass = 0, tresca = 0, coulomb = 0;
  Real closed = 0;       ///< by prescribed components, and off the gap
  Real unknown_gap = 0;  ///< what arithmetic leaves of it
  Vec slip_origin{};     ///< displacement that slip is counted from (theory: slip-history, moving-obstacles)
  bool friction = false;
  bool since_step = false;  ///< that includes the displacement at the end of the load step before
  bool alone = false;       ///< an obstacle that moves is joined to none
  bool grazing = false;     ///< whether it meets the sphere is a matter of rounding
};

/// u along a unit vector, as it is given.
struct GivenDirection {
  Vec direction{};
  Real value = 0;
};

/// What keeps an elastic body in plane stress from getting longer, over the strain that it would have: E/(1 −
/// ν).
Real expansion_stress(const Law& law);

struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::size_t> law_of_element;
  std::vector<Vec> load;            ///< F, one a node
  std::vector<std::int64_t> patch;  ///< of each node, where the result has that; else empty
  std::vector<Real> free_strain;    ///< α ΔT of each element in plane stress; empty: none
  /// Pressure of constrained thermal expansion at the points of the stiffness, of each element; empty where
  /// it is not warmer.
  std::vector<std::vector<Real>> expansion;
  std::vector<std::array<bool, 3>> held;  ///< components with a prescribed displacement
  std::vector<Vec> prescribed;
  /// Off the axes, by node: orthonormal, in free components (theory: held-directions).
  std::map<Index, std::vector<GivenDirection>> directions;
  std::vector<std::array<Vec, 3>> springs;  ///< stiffness between each node and the ground; empty: none
  std::vector<Real> contact_factor;         ///< of each contact entry
  Real time = 1;  ///< that the state has reached: of the load curves, or the load factor
  LoadPoint point;
  std::vector<ContactRow> rows;
  std::vector<std::int64_t> surface_tags;  ///< numbers of the nodes in contact.vtu, in its order
  std::vector<Vec> probes;
  Real tolerance = 1e-6L;
};

/// Of a case that the program has accepted, at the end of a load step; throws Failure for what the verifier
/// does not know. `folder`: where relative paths start. find_rows() adds the contact rows.
Problem read_problem(const nlohmann::json& document, const std::filesystem::path& folder,
                     const LoadPoint& point);

/// Puts an entry with a displacement, of components or along directions, on its nodes.
void hold(Problem& problem, const nlohmann::json& entry, Real factor);
/// Once all entries are held: leaves of each direction what others of its node do not give.
void find_directions(Problem& problem);
/// `v` of a node without what is given there.
Vec free_part(const Problem& problem, Index node, Vec v);

/// Finds the contact rows of a problem whose supports and load point are known.
void find_rows(const nlohmann::json& contact, const std::filesystem::path& folder, Problem& problem);

/// ∫ Nᵢ dS and ∫ Nᵢ n dS of a facet, one a node (theory: loads).
struct FacetIntegrals {
  std::vector<Real> area;
  std::vector<Vec> normal;
};
FacetIntegrals consistent(const Mesh& mesh, const Indices& facet);
/// The lumped mass of a facet's nodes and their share of its normal: the rule that turns a facet's
/// multipliers, and beds of springs, into forces. Six-node facets have the rule of their mid-sides, and
/// corners bear nothing.
FacetIntegrals contact_weights(const Mesh& mesh, const Indices& facet);
/// Outer normal times the area over that of the reference cell, at a point with these functions.
Vec normal_at(const Mesh& mesh, const Indices& facet, const Functions& at);

Vec read_vector(const nlohmann::json& list);

}  // namespace kacanov::verify
