// SPDX-License-Identifier: BSD-3-Clause
// One rank's share of a problem: its elements, all their nodes, and the ranks that share them.
#pragma once

#include <mpi.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <kacanov/communicator.hpp>
#include <kacanov/index_map.hpp>
#include <kacanov/problem.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// Ascending indices stored as runs of consecutive ones: at most eight bytes per index, and almost nothing if
/// the elements of a part are contiguous in the mesh.
struct IndexRuns {
  struct Run {
    std::int32_t first = 0;     ///< index
    std::int32_t position = 0;  ///< position of `first` in the list
  };
  std::vector<Run> runs;
  std::int32_t count = 0;

  std::size_t size() const noexcept { return static_cast<std::size_t>(count); }
  /// Appends `index`, which must exceed all indices in the list.
  void push_back(std::int32_t index) {
    if (runs.empty() || index - runs.back().first != count - runs.back().position)
      runs.push_back({index, count});
    ++count;
  }
  std::int32_t operator[](std::size_t position) const noexcept {
    const auto run = std::upper_bound(runs.begin(), runs.end(), position,
                                      [](std::size_t p, const Run& r) {
                                        return p < static_cast<std::size_t>(r.position);
                                      }) -
                     1;
    return run->first + static_cast<std::int32_t>(position) - run->position;
  }
  /// Returns the position of `index`, which must be in the list.
  std::int32_t position_of(std::int32_t index) const noexcept {
    const auto run = std::upper_bound(runs.begin(), runs.end(), index,
                                      [](std::int32_t i, const Run& r) { return i < r.first; }) -
                     1;
    return run->position + index - run->first;
  }
};

/// Elements are partitioned without overlap. A node is present on every rank that has one of its elements, or
/// a multi-node contact point that involves it; one of the ranks with its elements owns it. Owned nodes come
/// first, numbered for locality (node_order). Vectors over a part are consistent: every copy of a shared
/// entry holds the same bits.
struct Part {
  struct ComponentValue {
    std::int32_t component = 0;  ///< node · dim + c
    double value = 0.0;
    bool operator==(const ComponentValue&) const = default;
  };
  ElementType type = ElementType::tet4;
  PlaneState plane = PlaneState::strain;
  double thickness = 1.0;           ///< as in Model; all loads here are per unit thickness
  std::vector<double> coordinates;  ///< nodes × dim
  std::vector<std::int32_t> elements;
  std::vector<std::int32_t> node_index;               ///< index in Problem::mesh
  IndexRuns element_index;                            ///< likewise, in Problem::mesh
  std::vector<std::int64_t> node_tags, element_tags;  ///< the user's numbers; empty: index + 1
  IndexMap node_map;                                  ///< of the nodes
  std::int64_t total_elements = 0;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;  ///< empty: all elements follow laws[0]
  std::vector<ComponentValue> load;           ///< entries of F that are not zero, ascending; consistent
  std::vector<std::uint8_t> held;             ///< nodes × dim
  std::vector<ComponentValue> prescribed;     ///< one per held component, ascending
  std::vector<LoadFactors> steps;             ///< as in Problem
  std::vector<EntryForce> forces;             ///< likewise, with component numbers of the part
  std::vector<std::int32_t> prescribed_by;    ///< boundary entry of each of `prescribed`; only with `steps`
  std::vector<Support> supports;              ///< of owned nodes, by node and axis
  std::vector<AppliedLoad> applied;           ///< of the whole problem
  std::vector<HeldDirection> directions;      ///< of local nodes, owned ones first
  std::vector<NodeSpring> springs;            ///< of local nodes, owned ones first
  std::vector<ThermalPressure> thermal;       ///< of local elements
  /// Points of owned nodes come first, followed by the narrow points of ghosts. All nodes of an owned point
  /// are local; multi-node points are present on their owners only.
  ConstraintRows contact;
  std::int32_t owned_contact = 0;
  std::vector<PointShare> contact_shares;   ///< of owned points, by point
  bool wide_contact = false;                ///< whether any rank has multi-node points
  std::vector<std::int32_t> contact_index;  ///< index in Problem::contact
  std::int64_t total_contact = 0;
  std::vector<Probe> probes;  ///< probes that lie in this rank's elements
  std::vector<std::int32_t> probe_index;
  std::int32_t total_probes = 0;
  int loose_modes = 0;
  std::vector<LoosePiece> loose_pieces;  ///< as in Problem
  /// Points × 2: Tu of an obstacle that has moved, from which slip is measured; empty: none has moved. Not
  /// saved to files.
  std::vector<double> slip_origin;
  std::vector<double> start;                 ///< nodes × dim: initial displacement; empty: none
  std::vector<std::int64_t> pressure_patch;  ///< as in Body, set by join(). Not saved to files
  std::string no_equilibrium;                ///< as in Problem

  int dim() const noexcept { return dimension(type); }
  std::size_t nodes() const noexcept { return node_index.size(); }
  std::size_t element_count() const noexcept { return element_index.size(); }
  std::int64_t node_tag(std::size_t i) const noexcept {
    return node_tags.empty() ? std::int64_t{node_index[i]} + 1 : node_tags[i];
  }
  std::int64_t element_tag(std::size_t i) const noexcept {
    return element_tags.empty() ? std::int64_t{element_index[i]} + 1 : element_tags[i];
  }
  std::size_t unknowns() const noexcept { return coordinates.size(); }
  std::int32_t owned_nodes() const noexcept { return node_map.owned; }
  std::int64_t total_nodes() const noexcept { return node_map.total(); }
  std::size_t owned_unknowns() const noexcept {
    return static_cast<std::size_t>(owned_nodes()) * static_cast<std::size_t>(dim());
  }
  std::int64_t node_number(std::size_t i) const noexcept { return node_map.number(i); }
  /// f += F.
  void add_load(std::span<double> f) const noexcept {
    for (const auto& entry : load) f[entry.component] += entry.value;
  }
  /// Returns the position of a held component in `prescribed`.
  std::size_t prescribed_place(std::size_t component) const noexcept;
  /// Sets the held components of u to their prescribed values.
  void prescribe(std::span<double> u) const noexcept {
    for (const auto& p : prescribed) u[p.component] = p.value;
  }
  /// Whether any rank has pressure patches; the same result on all ranks.
  bool has_patches() const { return node_map.any(!pressure_patch.empty()); }
  Body body() const noexcept {
    Body whole{{type, coordinates, elements, plane}, laws, law_of_element};
    whole.pressure_patch = pressure_patch;
    return whole;
  }
};

/// Partitions the problem with METIS and passes the parts to `take` one after another, rank 0 last, so that
/// only one part exists at a time beside the problem. Call join() on each before use. Needs no MPI. Throws
/// InputError if the mesh is too small for this many ranks.
void split(const Problem& problem, int ranks, const std::function<void(int rank, Part&& part)>& take);

/// Connects the part of this rank to the other ranks of `comm`.
void join(Part& part, MPI_Comm comm);

/// Partitions the problem (given on rank 0, null elsewhere) over the ranks of `comm` with METIS and returns
/// each rank's part. Collective.
Part distribute(const Problem* problem, MPI_Comm comm);

/// Gathers nodes × components (owned entries) on rank 0, in the numbering of Problem::mesh; returns an empty
/// vector elsewhere. Collective.
std::vector<double> gather_nodal(const Part& part, std::span<const double> local, int components,
                                 CallSite at = CallSite());
/// The same for contact points × components, in the numbering of Problem::contact.
std::vector<double> gather_contact(const Part& part, std::span<const double> local, int components,
                                   CallSite at = CallSite());

/// Returns the ranks of `comm` as a Communicator; `comm` must outlive it.
Communicator mpi_communicator(MPI_Comm comm);

/// Returns the MPI communicator it was created from, or MPI_COMM_SELF if it was created otherwise.
MPI_Comm mpi_of(const Communicator& communicator);

/// Returns the means of tr ε(u) around the corners of every element, taken over all ranks: elements × 4, as
/// in Body::corner_dilatation; empty if no law needs them. Collective.
std::vector<double> corner_dilatation(const Part& part, std::span<const double> u);

}  // namespace kacanov
