// SPDX-License-Identifier: BSD-3-Clause
// Partitions a body into blocks of units, or reuses the partitioning of an operator.
#include "operator/division.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include <kacanov/locality.hpp>
#include "operator/layout.hpp"

namespace kacanov {
namespace {

/// Limit from 16-bit offsets of records of four values; records of idle lanes follow those of the block.
constexpr std::size_t most_records = (std::size_t{1} << 16) / 4 - 16;

/// Bytes of node records per block: coordinates, displacement and force.
constexpr std::size_t cache_bytes = 400 * 1024;

/// Splits lists of units until 16 bits address the nodes of each piece.
class Cutter {
 public:
  Cutter(const Units& units, std::size_t nodes) : units_(units), seen_(nodes, 0) {}

  void cut(std::vector<std::uint32_t> members, std::vector<std::vector<std::uint32_t>>& out) {
    if (members.empty()) return;
    if (count_nodes(members) <= most_records) return out.push_back(std::move(members));
    const auto half = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
    cut({members.begin(), half}, out);
    cut({half, members.end()}, out);
  }

 private:
  std::size_t count_nodes(std::span<const std::uint32_t> members) {
    std::size_t count = 0;
    ++list_;
    for (const std::uint32_t u : members)
      for (std::uint32_t k = 0; k < units_.node_count(u); ++k)
        if (std::exchange(seen_[at(units_.nodes_begin(u)[k])], list_) != list_) ++count;
    return count;
  }

  const Units& units_;
  std::vector<std::uint32_t> seen_;  ///< per node: the last list that contained it
  std::uint32_t list_ = 0;
};

/// Units of each part, in locality order of their first node. A unit belongs to the part with most of its
/// nodes.
std::vector<std::vector<std::uint32_t>> assign_units(const Division& division, int parts,
                                                     std::span<const std::int32_t> part) {
  const Units& units = division.units;
  std::vector<std::pair<std::int32_t, std::uint32_t>> keys(units.units.size());
  for (std::uint32_t u = 0; u < keys.size(); ++u) keys[u] = {division.rank[at(units.nodes_begin(u)[0])], u};
  std::sort(keys.begin(), keys.end());
  std::vector<std::vector<std::uint32_t>> members(parts);
  for (const auto& [key, u] : keys) {
    const std::int32_t* nodes = units.nodes_begin(u);
    const std::uint32_t count = units.node_count(u);
    std::int32_t best = 0;
    std::ptrdiff_t most = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::int32_t candidate = part[nodes[k]];
      const auto votes =
          std::count_if(nodes, nodes + count, [&](std::int32_t n) { return part[n] == candidate; });
      if (votes > most) most = votes, best = candidate;
    }
    members[best].push_back(u);
  }
  return members;
}

/// Recovers units from a layout's lanes.
class Reader {
 public:
  Reader(const Layout& from, ElementType type) : from_(from) { units_.type = type; }

  /// Pieces of fans in a block's lanes become separate units.
  std::vector<std::uint32_t> read_block(const BlockRange& block) {
    std::vector<std::uint32_t> members;
    for (std::size_t i = 0; i < block.group_count; ++i) {
      const simd::Group& group = from_.groups[block.first_group + i];
      const std::size_t lanes = from_.lanes, batches = group.batches;
      const bool apart = cell(units_.type).order == 2;  // see the layout's add_group
      for (std::size_t piece = 0; piece < batches * lanes; ++piece) {
        const std::size_t batch = apart ? piece % batches : piece / lanes;
        const std::size_t lane = apart ? piece / batches : piece % lanes;
        if (read_lane(block, group, batch, lane))
          members.push_back(static_cast<std::uint32_t>(units_.units.size() - 1));
      }
    }
    return members;
  }

  Units take() { return std::move(units_); }

 private:
  /// Adds the unit in a lane of a batch; returns false if the lane is idle.
  bool read_lane(const BlockRange& block, const simd::Group& group, std::size_t batch, std::size_t lane) {
    const std::size_t lanes = from_.lanes, per_element = points_per_element(units_.type);
    const std::uint32_t points = units_.points_of(group.shape, group.length);
    const std::size_t slots = block.first_slot + group.first_slot + batch * points * lanes + lane;
    if (from_.element_point[slots] < 0) return false;
    units_.units.push_back({group.shape, group.length, group.law,
                            static_cast<std::uint32_t>(units_.nodes.size()),
                            static_cast<std::uint32_t>(units_.elements.size())});
    for (std::size_t q = 0; q < points; q += per_element)
      units_.elements.push_back(
          static_cast<std::int32_t>(at(from_.element_point[slots + q * lanes]) / per_element));
    const std::uint32_t nodes = units_.nodes_of(group.shape, group.length);
    const std::size_t offsets = block.first_index + group.first_index + batch * nodes * lanes + lane;
    for (std::size_t k = 0; k < nodes; ++k)
      units_.nodes.push_back(from_.nodes[block.first_node + from_.index[offsets + k * lanes] / 4U]);
    return true;
  }

  const Layout& from_;
  Units units_;
};

}  // namespace

Division divide(const Body& body, int threads, std::size_t record_bytes) {
  Division division;
  division.units = make_units(body);
  const std::vector<std::int32_t> order = node_order(body.mesh);
  division.rank.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) division.rank[order[i]] = static_cast<std::int32_t>(i);
  const std::size_t per_block = cache_bytes / (3 * record_bytes);
  const std::size_t nodes = body.mesh.connectivity.empty() ? 0 : body.mesh.node_count();
  const std::size_t wanted = (nodes + per_block - 1) / per_block;
  // A multiple of the threads, with blocks large compared to their surface; at least one per thread if
  // possible.
  const std::size_t team = threads;
  const int parts = wanted == 0 ? 1 : static_cast<int>((wanted + team - 1) / team * team);
  Cutter cutter(division.units, body.mesh.node_count());
  for (auto& list : assign_units(division, parts, partition_nodes(body.mesh, order, parts)))
    cutter.cut(std::move(list), division.blocks);
  return division;
}

Division divided_as(const Layout& like, const Body& body, std::size_t joined) {
  Division division;
  Reader reader(like, body.mesh.type);
  std::vector<std::vector<std::uint32_t>> lists;
  for (std::size_t t = 0; t + 1 < like.share.size(); ++t)
    for (std::size_t b = like.share[t]; b < like.share[t + 1]; ++b) {
      auto members = reader.read_block(like.blocks[b]);
      if ((b - like.share[t]) % joined == 0) lists.emplace_back();
      lists.back().insert(lists.back().end(), members.begin(), members.end());
    }
  division.units = reader.take();
  Cutter cutter(division.units, body.mesh.node_count());
  for (auto& list : lists) cutter.cut(std::move(list), division.blocks);
  // Numbers nodes in the order of the blocks and of the nodes in them.
  division.rank.assign(body.mesh.node_count(), -1);
  std::int32_t next = 0;
  const std::size_t met = like.blocks.empty() ? 0 : like.blocks.back().first_node + like.blocks.back().count;
  for (std::size_t i = 0; i < met; ++i)
    if (std::int32_t& rank = division.rank[like.nodes[i]]; rank < 0) rank = next++;
  return division;
}

}  // namespace kacanov
