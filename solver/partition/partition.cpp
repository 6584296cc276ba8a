// SPDX-License-Identifier: BSD-3-Clause
// Partitions a problem and sends every rank its part.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <kacanov/constraint_rows.hpp>
#include <kacanov/error.hpp>
#include <kacanov/locality.hpp>
#include <kacanov/mesh.hpp>
#include <kacanov/pressure_patches.hpp>
#include "parallel/exchange.hpp"
#include "partition/part_fields.hpp"
#include "problem/rigid_modes.hpp"

namespace kacanov {

/// The ranks that have each node, ascending: through its elements (compressed rows), and for some nodes
/// through multi-node contact points.
struct Sharers {
  std::vector<std::size_t> start;
  std::vector<int> rank;
  std::map<std::size_t, std::set<int>> more;  ///< ranks that have the node without an element at it
  std::span<const int> by_elements(std::size_t node) const {
    return std::span(rank).subspan(start[node], start[node + 1] - start[node]);
  }
  std::vector<int> of(std::size_t node) const {
    const auto s = by_elements(node);
    std::vector<int> all(s.begin(), s.end());
    if (const auto found = more.find(node); found != more.end()) {
      all.insert(all.end(), found->second.begin(), found->second.end());
      std::sort(all.begin(), all.end());
    }
    return all;
  }
  bool is_shared(std::size_t node) const { return by_elements(node).size() > 1 || more.contains(node); }
  bool has(std::size_t node, int who) const {
    const auto s = by_elements(node);
    if (std::binary_search(s.begin(), s.end(), who)) return true;
    if (more.empty()) return false;
    const auto found = more.find(node);
    return found != more.end() && found->second.contains(who);
  }
  /// Shared nodes are assigned in turn, so that no rank owns a whole interface.
  int owner(std::size_t node) const {
    const auto s = by_elements(node);
    return s[node % s.size()];
  }
  /// Adds the nodes of each multi-node point to the rank that owns the point.
  void widen(const ConstraintRows& contact) {
    for (std::size_t i = 0; i < contact.size(); ++i) {
      if (!contact.is_wide(i)) continue;
      const int rank_of_point = owner(contact[i].node);
      for (const RowEntry& entry : contact.entries(i)) {
        const std::size_t node = entry.node;
        if (!has(node, rank_of_point)) more[node].insert(rank_of_point);
      }
    }
  }
};

/// Computes the sharers of all nodes from the ranks of the elements.
Sharers find_sharers(const Mesh& mesh, std::span<const std::uint16_t> part, int ranks);

Sharers find_sharers(const Mesh& mesh, std::span<const std::uint16_t> part, int ranks) {
  Sharers sharers;
  const std::size_t nodes = mesh.node_count();
  const std::size_t npe = nodes_per_element(mesh.type);
  sharers.start.assign(nodes + 1, 0);
  if (ranks == 1) {
    std::iota(sharers.start.begin(), sharers.start.end(), std::size_t{0});
    sharers.rank.assign(nodes, 0);
    return sharers;
  }
  // The first pass identifies the interior nodes, the vast majority, by their only rank; only the others need
  // lists.
  constexpr int none = -1, several = -2;
  std::vector<int> only(nodes, none);
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    int& rank = only[mesh.elements[k]];
    const int here = part[k / npe];
    if (rank == none) rank = here;
    if (rank != here) rank = several;
  }
  std::map<std::size_t, std::set<int>> lists;
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    const std::size_t n = mesh.elements[k];
    if (only[n] == several) lists[n].insert(part[k / npe]);
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    if (only[n] == several)
      sharers.rank.insert(sharers.rank.end(), lists[n].begin(), lists[n].end());
    else
      sharers.rank.push_back(only[n]);
    sharers.start[n + 1] = sharers.rank.size();
  }
  return sharers;
}

namespace {

using Index = std::int32_t;

/// Another rank as a sink, and rank 0 as a source, of fields.
struct OtherRank {
  int rank;
  MPI_Comm comm;
  void write(const void* data, std::size_t bytes) const { send_bytes(data, bytes, rank, comm); }
};
struct FirstRank {
  MPI_Comm comm;
  void expect(std::uint64_t, std::size_t) const {}
  void read(void* data, std::size_t bytes) const { receive_bytes(data, bytes, 0, comm); }
};

/// Returns the part of every element: the one that contains most of its corners, after METIS has partitioned
/// the nodes (in groups along `order`, so that the graph is small relative to the mesh). Ties are resolved in
/// rotation.
std::vector<std::uint16_t> partition_elements(const Mesh& mesh, std::span<const Index> order, int ranks) {
  std::vector<std::uint16_t> part(mesh.element_count(), 0);
  if (ranks == 1) return part;
  const std::vector<Index> node_part = partition_nodes(mesh.view(), order, ranks);
  const std::size_t stride = nodes_per_element(mesh.type);
  const std::size_t corners = cell(mesh.type).corners;
  for (std::size_t e = 0; e < part.size(); ++e) {
    std::array<Index, 8> of{};
    for (std::size_t a = 0; a < corners; ++a) of[a] = node_part[mesh.elements[e * stride + a]];
    std::ptrdiff_t most = 0;
    for (std::size_t k = 0; k < corners; ++k) {
      const Index candidate = of[(e + k) % corners];
      const auto votes = std::count(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(corners), candidate);
      if (votes <= most) continue;
      most = votes;
      part[e] = static_cast<std::uint16_t>(candidate);
    }
  }
  return part;
}

class Splitter {
 public:
  Splitter(const Problem& problem, int ranks)
      : problem_(problem),
        ranks_(ranks),
        order_(node_order(problem.mesh.view())),
        part_of_(partition_elements(problem.mesh, order_, ranks)),
        sharers_(find_sharers(problem.mesh, part_of_, ranks)),
        first_(static_cast<std::size_t>(ranks) + 1, 0),
        global_(problem.mesh.node_count()),
        local_(problem.mesh.node_count(), -1) {
    refuse_empty_parts();
    if (ranks > 1) sharers_.widen(problem.contact);
    const std::size_t nodes = problem.mesh.node_count();
    for (std::size_t n = 0; n < nodes; ++n) ++first_[static_cast<std::size_t>(sharers_.owner(n)) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    auto next = first_;
    for (const Index index : order_) {
      const std::size_t n = index;
      global_[n] = next[sharers_.owner(n)]++;
    }
  }

  Part part(int rank) {
    Part part;
    part.plane = problem_.mesh.plane;
    part.thickness = problem_.mesh.thickness;
    take_nodes(part, rank);
    take_elements(part, rank);
    plan_scatters(part, rank);
    take_contact(part, rank);
    take_probes(part, rank);
    part.laws = problem_.laws;
    part.directions = of_local_nodes(problem_.directions);
    part.springs = of_local_nodes(problem_.springs);
    take_thermal(part, rank);
    part.steps = problem_.steps;
    part.applied = problem_.applied;
    part.loose_modes = problem_.loose_modes;
    part.loose_pieces = problem_.loose_pieces;
    part.no_equilibrium = problem_.no_equilibrium;
    part.start = rigid_start(problem_, part.node_index);
    for (const Index n : part.node_index) local_[n] = -1;
    return part;
  }

 private:
  void refuse_empty_parts() const {
    std::vector<std::uint8_t> filled(ranks_, 0);
    for (const std::uint16_t rank : part_of_) filled[rank] = 1;
    if (std::count(filled.begin(), filled.end(), 1) == ranks_) return;
    throw InputError("a mesh of " + std::to_string(part_of_.size()) + " elements cannot be split into " +
                     std::to_string(ranks_) + " parts: some would be empty");
  }

  void take_nodes(Part& part, int rank) {
    const Mesh& mesh = problem_.mesh;
    const std::size_t dim = mesh.dim();
    part.type = mesh.type;
    part.total_elements = static_cast<std::int64_t>(mesh.element_count());
    part.node_map.rank = rank;
    part.node_map.ranks = ranks_;
    part.node_map.starts = first_;
    for (const bool owned : {true, false}) {
      for (const Index index : order_) {
        const std::size_t n = index;
        if ((sharers_.owner(n) == rank) != owned || !sharers_.has(n, rank)) continue;
        local_[n] = static_cast<Index>(part.node_index.size());
        part.node_index.push_back(index);
      }
      if (owned) part.node_map.owned = static_cast<Index>(part.node_index.size());
    }
    part.node_index.shrink_to_fit();
    const std::size_t count = part.node_index.size();
    part.coordinates.reserve(count * dim);
    part.held.reserve(count * dim);
    if (!mesh.node_tags.empty()) part.node_tags.reserve(count);
    for (const Index index : part.node_index) {
      const std::size_t n = index;
      if (!mesh.node_tags.empty()) part.node_tags.push_back(mesh.node_tags[n]);
      if (local_[n] >= part.owned_nodes()) part.node_map.ghosts.push_back(global_[n]);
      for (std::size_t c = n * dim; c < (n + 1) * dim; ++c) {
        part.coordinates.push_back(mesh.coordinates[c]);
        const auto component = static_cast<Index>(part.held.size());
        if (problem_.load[c] != 0.0) part.load.push_back({component, problem_.load[c]});
        if (problem_.held[c] != 0) {
          part.prescribed.push_back({component, problem_.prescribed[c]});
          if (!problem_.steps.empty()) part.prescribed_by.push_back(problem_.holder[c]);
        }
        part.held.push_back(problem_.held[c]);
      }
    }
    take_forces(part);
    take_supports(part, rank);
  }

  void take_forces(Part& part) const {
    const Index dim = problem_.mesh.dim();
    for (EntryForce force : problem_.forces) {
      const Index node = local_[static_cast<std::size_t>(force.component / dim)];
      if (node < 0) continue;
      force.component = node * dim + force.component % dim;
      part.forces.push_back(force);
    }
    std::stable_sort(part.forces.begin(), part.forces.end(),
                     [](const EntryForce& a, const EntryForce& b) { return a.component < b.component; });
  }

  /// Selects per-node data of the local nodes and renumbers them.
  template <class OfNode>
  std::vector<OfNode> of_local_nodes(const std::vector<OfNode>& all) const {
    std::vector<OfNode> mine;
    for (OfNode one : all) {
      one.node = local_[one.node];
      if (one.node >= 0) mine.push_back(one);
    }
    std::stable_sort(mine.begin(), mine.end(),
                     [](const OfNode& a, const OfNode& b) { return a.node < b.node; });
    return mine;
  }

  void take_thermal(Part& part, int rank) const {
    for (const ThermalPressure& thermal : problem_.thermal) {
      ThermalPressure mine{thermal.entry, {}};
      const std::size_t width = thermal.of_element.size() / part_of_.size();
      for (std::size_t k = 0; k < thermal.of_element.size(); ++k)
        if (part_of_[k / width] == rank) mine.of_element.push_back(thermal.of_element[k]);
      part.thermal.push_back(std::move(mine));
    }
  }

  void take_supports(Part& part, int rank) const {
    for (Support support : problem_.supports) {
      const std::size_t n = support.node;
      if (sharers_.owner(n) != rank) continue;
      support.node = local_[n];
      part.supports.push_back(support);
    }
    std::sort(part.supports.begin(), part.supports.end(), [](const Support& a, const Support& b) {
      return std::tie(a.node, a.axis, a.entry) < std::tie(b.node, b.axis, b.entry);
    });
  }

  void take_elements(Part& part, int rank) const {
    const Mesh& mesh = problem_.mesh;
    const std::size_t npe = nodes_per_element(mesh.type);
    const std::size_t count = std::count(part_of_.begin(), part_of_.end(), rank);
    const bool several_laws = problem_.laws.size() > 1;
    if (!mesh.element_tags.empty()) part.element_tags.reserve(count);
    if (several_laws) part.law_of_element.reserve(count);
    part.elements.reserve(count * npe);
    for (std::size_t e = 0; e < part_of_.size(); ++e) {
      if (part_of_[e] != rank) continue;
      part.element_index.push_back(static_cast<Index>(e));
      if (!mesh.element_tags.empty()) part.element_tags.push_back(mesh.element_tags[e]);
      if (several_laws) part.law_of_element.push_back(problem_.law_of_element[e]);
      for (std::size_t a = 0; a < npe; ++a) part.elements.push_back(local_[mesh.elements[e * npe + a]]);
    }
  }

  void plan_scatters(Part& part, int rank) const {
    std::vector<IndexMap::Neighbour> all(ranks_);
    // Both sides list their nodes in the order of the mesh, so the lists match.
    std::vector<Index> ascending = part.node_index;
    std::sort(ascending.begin(), ascending.end());
    for (const Index index : ascending) {
      const std::size_t n = index;
      if (!sharers_.is_shared(n)) continue;
      const Index here = local_[n];
      part.node_map.shared.push_back(here);
      const int owner = sharers_.owner(n);
      for (const int other : sharers_.of(n)) {
        if (other == rank) continue;
        auto& neighbour = all[other];
        neighbour.shared.push_back(here);
        if (owner == rank) neighbour.send.push_back(here);
        if (owner == other) neighbour.receive.push_back(here);
      }
    }
    for (int other = 0; other < ranks_; ++other) {
      auto& neighbour = all[other];
      neighbour.rank = other;
      if (!neighbour.shared.empty()) part.node_map.neighbours.push_back(std::move(neighbour));
    }
  }

  void take_contact(Part& part, int rank) const {
    const ConstraintRows& contact = problem_.contact;
    part.total_contact = static_cast<std::int64_t>(contact.size());
    part.wide_contact = contact.any_wide();
    // Points of one node are contiguous: Traces and Space rely on it.
    std::vector<Index> order(contact.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return contact[a].node < contact[b].node; });
    const auto to_local = [&](Index& node) { node = local_[node]; };
    for (const bool owned : {true, false}) {
      for (const Index index : order) {
        const std::size_t i = index;
        ContactPoint point = contact[i];
        const std::size_t n = point.node;
        if (local_[n] < 0 || (sharers_.owner(n) == rank) != owned) continue;
        if (!owned && contact.is_wide(i)) continue;
        std::vector<RowEntry> entries(contact.entries(i).begin(), contact.entries(i).end());
        to_local(point.node);
        for (RowEntry& entry : entries) to_local(entry.node);
        part.contact.push_back(point, entries);
        part.contact_index.push_back(index);
      }
      if (owned) part.owned_contact = static_cast<Index>(part.contact.size());
    }
    take_shares(part);
  }

  void take_shares(Part& part) const {
    const std::vector<PointShare>& shares = problem_.contact_shares;
    const auto before = [](const PointShare& share, Index point) { return share.point < point; };
    for (Index i = 0; i < part.owned_contact; ++i) {
      const Index point = part.contact_index[i];
      for (auto share = std::lower_bound(shares.begin(), shares.end(), point, before);
           share != shares.end() && share->point == point; ++share)
        part.contact_shares.push_back({i, share->entry, share->share});
    }
  }

  void take_probes(Part& part, int rank) const {
    part.total_probes = static_cast<Index>(problem_.probes.size());
    for (std::size_t i = 0; i < problem_.probes.size(); ++i) {
      const std::size_t e = problem_.probes[i].element;
      if (part_of_[e] != rank) continue;
      Probe probe = problem_.probes[i];
      probe.element = part.element_index.position_of(probe.element);
      part.probes.push_back(probe);
      part.probe_index.push_back(static_cast<Index>(i));
    }
  }

  const Problem& problem_;
  int ranks_;
  std::vector<Index> order_;  // nodes in an order of locality
  std::vector<std::uint16_t> part_of_;
  Sharers sharers_;
  std::vector<std::int64_t> first_, global_;
  std::vector<Index> local_;
};

}  // namespace

std::size_t Part::prescribed_place(std::size_t component) const noexcept {
  const auto at = std::lower_bound(
      prescribed.begin(), prescribed.end(), component,
      [](const ComponentValue& p, std::size_t c) { return static_cast<std::size_t>(p.component) < c; });
  return static_cast<std::size_t>(at - prescribed.begin());
}

void split(const Problem& problem, int ranks, const std::function<void(int rank, Part&& part)>& take) {
  Splitter splitter(problem, ranks);
  for (int rank = 1; rank < ranks; ++rank) take(rank, splitter.part(rank));
  take(0, splitter.part(0));
}

void join(Part& part, MPI_Comm comm) {
  static_cast<Communicator&>(part.node_map) = mpi_communicator(comm);
  part.pressure_patch = pressure_patches(part.body(), part.node_map);
}

Part distribute(const Problem* problem, MPI_Comm comm) {
  const Communicator ranks = mpi_communicator(comm);
  std::optional<Splitter> splitter;
  std::string refusal;
  if (ranks.rank == 0) try {
      splitter.emplace(*problem, ranks.ranks);
    } catch (const InputError& error) {
      refusal = error.what();
    }
  refuse_together(refusal, ranks);
  Part part;
  if (ranks.rank == 0) {
    for (int rank = 1; rank < ranks.ranks; ++rank) {
      OtherRank sink{rank, comm};
      Part one = splitter->part(rank);
      FieldWriter{sink}(one);
    }
    part = splitter->part(0);
  } else {
    FirstRank source{comm};
    FieldReader{source}(part);
  }
  join(part, comm);
  return part;
}

}  // namespace kacanov
