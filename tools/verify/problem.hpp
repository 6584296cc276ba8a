// SPDX-License-Identifier: BSD-3-Clause
// What a case asks for on its mesh: loads, supports, laws, contact rows.
#pragma once

#include "verify/law.hpp"
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
  Real closed = 0;  ///< by prescribed components, and off the gap
  Real gap_from =
      0;  ///< lengths that the gap is a difference of, which in double leaves some of them unknown
  bool friction = false;
  bool grazing = false;  ///< whether it meets the sphere is a matter of rounding
};

struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::size_t> law_of_element;
  std::vector<Vec> load;                  ///< F, one a node
  std::vector<std::array<bool, 3>> held;  ///< components with a prescribed displacement
  std::vector<Vec> prescribed;
  std::vector<Real> contact_factor;  ///< of each contact entry
  std::vector<ContactRow> rows;
  std::vector<std::int64_t> surface_tags;  ///< numbers of the nodes in contact.vtu, in its order
  std::vector<Vec> probes;
  Real tolerance = 1e-6L;
};

/// Of a case that the program has accepted; throws Failure for what the verifier does not know. `folder`:
/// where relative paths start; load: the factor of the whole load, or with load curves the time.
Problem read_problem(const nlohmann::json& document, const std::filesystem::path& folder, Real load);

/// Finds the contact rows of a problem whose supports are known.
void find_rows(const nlohmann::json& contact, Problem& problem);

/// ∫ Nᵢ dS and ∫ Nᵢ n dS of a facet, one a node (theory: loads).
struct FacetIntegrals {
  std::vector<Real> area;
  std::vector<Vec> normal;
};
FacetIntegrals consistent(const Mesh& mesh, const Indices& facet);
/// Outer normal times the area over that of the reference cell, at a point with these functions.
Vec normal_at(const Mesh& mesh, const Indices& facet, const Functions& at);

Vec read_vector(const nlohmann::json& list);

}  // namespace kacanov::verify
