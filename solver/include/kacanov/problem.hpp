// SPDX-License-Identifier: BSD-3-Clause
// Mesh, laws, boundary conditions and contact, validated once, then trusted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/constraint_rows.hpp>
#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>
#include <kacanov/totals.hpp>

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

/// A point of the load curves: what each entry is multiplied by.
struct LoadFactors {
  double time = 0.0;
  std::vector<double> boundary, contact;  ///< one an entry
};

/// What a boundary entry puts on one component of a node.
struct EntryForce {
  std::int32_t component = 0;  ///< node · dim + c
  std::int32_t entry = 0;
  double value = 0.0;
};

/// That a displacement entry holds a component of a node; several may hold the same one.
struct Support {
  std::int32_t node = 0, axis = 0;
  std::int32_t entry = 0;  ///< index into Model::boundary
  bool operator==(const Support&) const = default;
};

/// A direction off the axes that a node's displacement is given along (theory: held-directions).
struct HeldDirection {
  std::int32_t node = 0, entry = 0;  ///< index into Model::boundary
  Vector3 direction{};               ///< unit, in free components, orthogonal to the others of its node
  double value = 0.0;                ///< of u along it
};

/// Those of a node, in a list by node.
std::span<const HeldDirection> directions_of(std::span<const HeldDirection> all, std::int32_t node);
/// `v` without its part along them.
Vector3 project_out(std::span<const HeldDirection> directions, Vector3 v);

/// What a spring entry puts between a node and the ground (theory: springs).
struct NodeSpring {
  std::int32_t node = 0, entry = 0;    ///< index into Model::boundary
  std::array<Vector3, 3> stiffness{};  ///< symmetric, positive semidefinite
};

/// A temperature entry: the pressure 3 k₀ α ΔT of each element, which no strain means (theory: expansion), in
/// plane stress E α ΔT / (1 − ν) (theory: expansion-in-plane).
/// Its mean over the element, and where it differs within elements those of the element's corners besides.
struct ThermalPressure {
  std::int32_t entry = 0;          ///< index into Model::boundary
  std::vector<double> of_element;  ///< elements × 1, or × (1 + corners); at the factor 1
};

/// A contact point that several entries were joined in: what of it belongs to one of them, by its mass.
struct PointShare {
  std::int32_t point = 0;
  std::int32_t entry = 0;  ///< index into Model::contact
  double share = 1.0;
};

/// What a traction, pressure or body force comes to.
struct AppliedLoad {
  std::int32_t entry = 0;  ///< index into Model::boundary
  Resultant total;
};

/// The whole problem, on one rank.
struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;
  std::vector<double> load;          ///< F: nodes × dim; with load curves that of their first step
  std::vector<std::uint8_t> held;    ///< nodes × dim: 1 where the displacement is given
  std::vector<double> prescribed;    ///< nodes × dim: its value
  std::vector<LoadFactors> steps;    ///< load curves, from the time 0 on; empty: none, and so are these:
  std::vector<EntryForce> forces;    ///< F entry by entry at the factor 1, ascending by component
  std::vector<std::int32_t> holder;  ///< nodes × dim: boundary entry that gives the displacement, else −1
  std::vector<Support> supports;     ///< by node and axis
  std::vector<AppliedLoad> applied;  ///< at the factor 1
  std::vector<HeldDirection> directions;  ///< by node
  std::vector<NodeSpring> springs;        ///< by node
  std::vector<ThermalPressure> thermal;
  ConstraintRows contact;
  std::vector<PointShare> contact_shares;  ///< of points of several entries, by point
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
