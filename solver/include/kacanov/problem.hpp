// SPDX-License-Identifier: BSD-3-Clause
// The discrete problem: mesh, laws, boundary conditions and contact, validated once by build_problem().
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

/// A small rigid motion: rotation about a centre, and translation.
struct PieceMotion {
  Vector3 centre{}, turn{}, shift{};
};

/// A piece of the mesh with rigid-body modes that only contact constrains (theory: loose-modes).
struct LoosePiece {
  std::string name;  ///< as messages call it
  Vector3 centre{};
  double radius = 0.0;
  /// 6 × 6 Gram matrix of the constraint rows of its supports: rotations about the centre in units of the
  /// radius, then translations.
  std::array<double, 36> by_displacement{};
};

/// A point of the load curves: the factor of each entry.
struct LoadFactors {
  double time = 0.0;
  std::vector<double> boundary, contact;  ///< one per entry
};

/// Contribution of a boundary entry to the force on one component of a node.
struct EntryForce {
  std::int32_t component = 0;  ///< node · dim + c
  std::int32_t entry = 0;
  double value = 0.0;
};

/// Records that a displacement entry prescribes a component of a node; several entries may prescribe the same
/// one.
struct Support {
  std::int32_t node = 0, axis = 0;
  std::int32_t entry = 0;  ///< index into Model::boundary
  bool operator==(const Support&) const = default;
};

/// A direction not along an axis in which a node's displacement is prescribed (theory: held-directions).
struct HeldDirection {
  std::int32_t node = 0, entry = 0;  ///< index into Model::boundary
  Vector3 direction{};  ///< unit vector in free components, orthogonal to the node's other directions
  double value = 0.0;   ///< prescribed displacement along `direction`
};

/// Returns the directions of one node from a list sorted by node.
std::span<const HeldDirection> directions_of(std::span<const HeldDirection> all, std::int32_t node);
/// Returns `v` without its components along `directions`.
Vector3 project_out(std::span<const HeldDirection> directions, Vector3 v);

/// Stiffness of a spring entry between a node and the ground (theory: springs).
struct NodeSpring {
  std::int32_t node = 0, entry = 0;    ///< index into Model::boundary
  std::array<Vector3, 3> stiffness{};  ///< symmetric, positive semidefinite
};

/// A temperature entry: the pressure 3 k₀ α ΔT of each element, with respect to zero strain (theory:
/// expansion); in plane stress E α ΔT / (1 − ν) (theory: expansion-in-plane). Stores its mean over the
/// element, and the values at the element's corners if it varies within elements.
struct ThermalPressure {
  std::int32_t entry = 0;          ///< index into Model::boundary
  std::vector<double> of_element;  ///< elements × 1, or × (1 + corners); at the factor 1
};

/// The share of one entry, by mass, in a contact point that merges several entries.
struct PointShare {
  std::int32_t point = 0;
  std::int32_t entry = 0;  ///< index into Model::contact
  double share = 1.0;
};

/// Resultant of a traction, pressure or body force.
struct AppliedLoad {
  std::int32_t entry = 0;  ///< index into Model::boundary
  Resultant total;
};

/// The complete problem, on one rank.
struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;
  std::vector<double> load;        ///< F: nodes × dim; with load curves, F of their first step
  std::vector<std::uint8_t> held;  ///< nodes × dim: 1 where the displacement is prescribed
  std::vector<double> prescribed;  ///< nodes × dim: its value
  /// Load curves from time 0 on; without them empty, like `forces` and `holder`.
  std::vector<LoadFactors> steps;
  std::vector<EntryForce> forces;  ///< F entry by entry at factor 1, ascending by component
  /// Nodes × dim: boundary entry that prescribes the displacement, else −1.
  std::vector<std::int32_t> holder;
  std::vector<Support> supports;          ///< sorted by node and axis
  std::vector<AppliedLoad> applied;       ///< at factor 1
  std::vector<HeldDirection> directions;  ///< sorted by node
  std::vector<NodeSpring> springs;        ///< sorted by node
  std::vector<ThermalPressure> thermal;
  ConstraintRows contact;
  std::vector<PointShare> contact_shares;  ///< of points that merge several entries, sorted by point
  std::vector<Probe> probes;
  int loose_modes = 0;  ///< number of rigid-body modes constrained by contact only
  std::vector<LoosePiece> loose_pieces;
  /// Rest positions, as rigid bodies, of pieces held by contact only; used as initial guess.
  std::vector<PieceMotion> motions;
  /// Index into motions, −1 for none; empty: all nodes move by motions[0].
  std::vector<std::int32_t> motion_of_node;
  std::string no_equilibrium;  ///< why the loads of such a piece cannot be in equilibrium; empty if they can
  std::vector<std::string> warnings;
};

/// Frees what is not needed once the parts exist: the arrays over nodes and elements, and in 3D also the
/// elements and inner nodes. The rest serves pictures and output: the boundary, contact points and named
/// facets; nodes are renumbered. Returns the former number of each remaining node.
std::vector<std::int32_t> keep_boundary(Problem& problem);

/// Resolves every `on`, assembles the load, and computes traces and gaps. Throws InputError with the path in
/// the case file ("boundary[1].on: ..."): unknown names (with a list of those that exist), empty selections,
/// contact without facets, materials that overlap or leave elements without one, unconstrained rigid-body
/// modes, probes outside the body.
Problem build_problem(Mesh mesh, const Model& model);

}  // namespace kacanov
