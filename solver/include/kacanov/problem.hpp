// SPDX-License-Identifier: BSD-3-Clause
// Mesh, laws, boundary conditions and contact, validated once, then trusted.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <kacanov/constraint_rows.hpp>
#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

struct Probe {
  Vector3 point{};
  std::int32_t element = 0;
  std::array<double, most_nodes> weights{};  ///< shape functions at the point
};

/// A rigid motion: small turn about a centre and shift.
struct PieceMotion {
  Vector3 centre{}, turn{}, shift{};
};

/// The whole problem, on one rank.
struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;
  std::vector<double> load;        ///< F: nodes × dim
  std::vector<std::uint8_t> held;  ///< nodes × dim: 1 where the displacement is given
  std::vector<double> prescribed;  ///< nodes × dim: its value
  ConstraintRows contact;
  std::vector<Probe> probes;
  int loose_modes = 0;  ///< rigid modes that only the contact holds
  /// Of pieces that contact alone holds: where they come to rest as rigid bodies, to start from.
  std::vector<PieceMotion> motions;
  std::vector<std::int32_t>
      motion_of_node;          ///< index into motions, −1 for none; empty: all move by motions[0]
  std::string no_equilibrium;  ///< why the loads of such a piece cannot be in balance; empty where they can
  std::vector<std::string> warnings;
};

/// Frees what only the parts need once they are made: the arrays over nodes and elements, and in 3D the
/// elements and inner nodes themselves. What is left serves pictures and output: the boundary, contact
/// points, named facets; nodes are renumbered. Returns the former number of each node that is left.
std::vector<std::int32_t> keep_boundary(Problem& problem);

/// Resolves every `on`, assembles the load, finds traces and gaps. Throws InputError in the words of the case
/// file ("boundary[1].on: ..."): unknown names with those that exist, empty selections, contact
/// without facets, materials that overlap or leave elements without one, rigid modes that nothing
/// holds, probes outside the body.
Problem build_problem(Mesh mesh, const Model& model);

}  // namespace kacanov
