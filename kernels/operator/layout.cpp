// SPDX-License-Identifier: BSD-3-Clause
// Partitions a body into blocks and lays out their data: batches, local indices, shared nodes.
#include "operator/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include <kacanov/locality.hpp>
#include "operator/nodal_pressure.hpp"

namespace kacanov {
namespace {

/// Limit from 16-bit offsets of records of four values; records of idle lanes follow those of the block.
constexpr std::size_t most_records = (std::size_t{1} << 16) / 4 - 16;

/// Bytes of node records per block: coordinates, displacement and force.
constexpr std::size_t cache_bytes = 400 * 1024;

/// Splits lists of items until 16 bits address the nodes of each piece.
class Cutter {
 public:
  Cutter(const WorkItems& items, std::size_t nodes) : items_(items), seen_(nodes, 0) {}

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
      for (std::uint32_t k = 0; k < items_.node_count(u); ++k)
        if (std::exchange(seen_[at(items_.nodes_begin(u)[k])], list_) != list_) ++count;
    return count;
  }

  const WorkItems& items_;
  std::vector<std::uint32_t> seen_;  ///< per node: the last list that contained it
  std::uint32_t list_ = 0;
};

/// Work items of each part, in locality order of their first node. An item belongs to the part with most of
/// its nodes.
std::vector<std::vector<std::uint32_t>> assign_items(const Partitioning& partitioning, int parts,
                                                     std::span<const std::int32_t> part) {
  const WorkItems& items = partitioning.items;
  std::vector<std::pair<std::int32_t, std::uint32_t>> keys(items.list.size());
  for (std::uint32_t u = 0; u < keys.size(); ++u)
    keys[u] = {partitioning.rank[at(items.nodes_begin(u)[0])], u};
  std::sort(keys.begin(), keys.end());
  std::vector<std::vector<std::uint32_t>> members(parts);
  for (const auto& [key, u] : keys) {
    const std::int32_t* nodes = items.nodes_begin(u);
    const std::uint32_t count = items.node_count(u);
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

/// Recovers items from a layout's lanes.
class Reader {
 public:
  Reader(const Layout& from, ElementType type) : from_(from) { items_.type = type; }

  /// Pieces of fans in a block's lanes become separate items.
  std::vector<std::uint32_t> read_block(const BlockRange& block) {
    std::vector<std::uint32_t> members;
    for (std::size_t i = 0; i < block.group_count; ++i) {
      const simd::Group& group = from_.groups[block.first_group + i];
      const std::size_t lanes = from_.lanes, batches = group.batches;
      const bool apart = cell(items_.type).order == 2;  // see the layout's add_group
      for (std::size_t piece = 0; piece < batches * lanes; ++piece) {
        const std::size_t batch = apart ? piece % batches : piece / lanes;
        const std::size_t lane = apart ? piece / batches : piece % lanes;
        if (read_lane(block, group, batch, lane))
          members.push_back(static_cast<std::uint32_t>(items_.list.size() - 1));
      }
    }
    return members;
  }

  WorkItems take() { return std::move(items_); }

 private:
  /// Adds the item in a lane of a batch; returns false if the lane is idle.
  bool read_lane(const BlockRange& block, const simd::Group& group, std::size_t batch, std::size_t lane) {
    const std::size_t lanes = from_.lanes, per_element = points_per_element(items_.type);
    const std::uint32_t points = items_.points_of(group.shape, group.length);
    const std::size_t slots = block.first_slot + group.first_slot + batch * points * lanes + lane;
    if (from_.element_point[slots] < 0) return false;
    items_.list.push_back({group.shape, group.length, group.law,
                           static_cast<std::uint32_t>(items_.nodes.size()),
                           static_cast<std::uint32_t>(items_.elements.size())});
    for (std::size_t q = 0; q < points; q += per_element)
      items_.elements.push_back(
          static_cast<std::int32_t>(at(from_.element_point[slots + q * lanes]) / per_element));
    const std::uint32_t nodes = items_.nodes_of(group.shape, group.length);
    const std::size_t offsets = block.first_index + group.first_index + batch * nodes * lanes + lane;
    for (std::size_t k = 0; k < nodes; ++k)
      items_.nodes.push_back(from_.nodes[block.first_node + from_.index[offsets + k * lanes] / 4U]);
    return true;
  }

  const Layout& from_;
  WorkItems items_;
};

}  // namespace

Partitioning partition(const Body& body, int threads, std::size_t record_bytes) {
  Partitioning partitioning;
  partitioning.items = make_work_items(body);
  const std::vector<std::int32_t> order = node_order(body.mesh);
  partitioning.rank.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) partitioning.rank[order[i]] = static_cast<std::int32_t>(i);
  const std::size_t per_block = cache_bytes / (3 * record_bytes);
  const std::size_t nodes = body.mesh.connectivity.empty() ? 0 : body.mesh.node_count();
  const std::size_t wanted = (nodes + per_block - 1) / per_block;
  // A multiple of the threads, with blocks large compared to their surface; at least one per thread if
  // possible.
  const std::size_t team = threads;
  const int parts = wanted == 0 ? 1 : static_cast<int>((wanted + team - 1) / team * team);
  Cutter cutter(partitioning.items, body.mesh.node_count());
  for (auto& list : assign_items(partitioning, parts, partition_nodes(body.mesh, order, parts)))
    cutter.cut(std::move(list), partitioning.blocks);
  return partitioning;
}

Partitioning partition_as(const Layout& like, const Body& body, std::size_t joined) {
  Partitioning partitioning;
  Reader reader(like, body.mesh.type);
  std::vector<std::vector<std::uint32_t>> lists;
  for (std::size_t t = 0; t + 1 < like.share.size(); ++t)
    for (std::size_t b = like.share[t]; b < like.share[t + 1]; ++b) {
      auto members = reader.read_block(like.blocks[b]);
      if ((b - like.share[t]) % joined == 0) lists.emplace_back();
      lists.back().insert(lists.back().end(), members.begin(), members.end());
    }
  partitioning.items = reader.take();
  Cutter cutter(partitioning.items, body.mesh.node_count());
  for (auto& list : lists) cutter.cut(std::move(list), partitioning.blocks);
  // Numbers nodes in the order of the blocks and of the nodes in them.
  partitioning.rank.assign(body.mesh.node_count(), -1);
  std::int32_t next = 0;
  const std::size_t met = like.blocks.empty() ? 0 : like.blocks.back().first_node + like.blocks.back().count;
  for (std::size_t i = 0; i < met; ++i)
    if (std::int32_t& rank = partitioning.rank[like.nodes[i]]; rank < 0) rank = next++;
  return partitioning;
}

namespace {

using simd::Shape;

/// Records for idle lanes: an element with positive volume and no displacement.
std::vector<std::array<double, 3>> idle_positions(ElementType type) {
  if (type == ElementType::tet4) return {{0, 0, 0}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto nodes = cell(type).reference;
  return {nodes.begin(), nodes.end()};
}

/// Idle record of node k of a lane. The ring of a fan alternates between two positions; the third one ends a
/// closed ring of odd length.
std::uint32_t idle_record(ElementType type, Shape shape, std::uint32_t length, std::uint32_t k) {
  if (shape != Shape::open_fan && shape != Shape::closed_fan) return k;
  if (type == ElementType::tet10) {
    constexpr std::uint32_t edge[3] = {0, 1, 4}, round[8] = {2, 6, 5, 8, 3, 7, 9, 8};
    return k < 3 ? edge[k] : round[(k - 3) % 8];
  }
  if (k < 2) return k;
  const bool odd_end = shape == Shape::closed_fan && length % 2 == 1 && k == length + 1;
  return odd_end ? 4 : 2 + k % 2;
}

/// An item, or a part of a fan, in one lane: fans may be split to fill batches.
struct Piece {
  std::uint32_t item;
  std::uint8_t from;  ///< first element of the fan
};

struct Builder {
  const Body& body;
  const WorkItems& items;
  std::span<const std::int32_t> rank;  ///< locality number per node
  Layout layout;
  std::vector<std::int32_t> local;  ///< local number per node in the current block, −1 if absent

  using Key = std::tuple<std::uint16_t, Shape, std::uint8_t>;  ///< law, shape, length
  using Classes = std::map<Key, std::vector<Piece>>;

  const std::int32_t* item_nodes(std::uint32_t u) const { return items.nodes_begin(u); }

  /// Node k of a piece of this shape and length. A closed ring opened into a chain ends at its first node.
  std::int32_t piece_node(const Piece& piece, Shape shape, std::uint32_t k) const {
    const std::int32_t* nodes = item_nodes(piece.item);
    if (shape != Shape::open_fan || k < 2) return nodes[k];
    if (items.type == ElementType::tet10) return k < 3 ? nodes[k] : nodes[k + 4U * piece.from];
    const std::uint32_t ring = items.node_count(piece.item) - 2;
    return nodes[2 + (piece.from + k - 2) % ring];
  }

  /// Sorts a block's items into classes. Items that would fill less than half of a batch move to a shorter
  /// class: closed fans are opened, open fans halved.
  Classes classify(std::span<const std::uint32_t> members) const {
    Classes classes;
    for (const std::uint32_t u : members) {
      const WorkItem& item = items.list[u];
      classes[{item.law, item.shape, item.length}].push_back({u, 0});
    }
    const std::size_t lanes = layout.lanes;
    const auto cut_rest = [&](std::uint16_t law, Shape shape, std::uint8_t length) {
      const auto found = classes.find({law, shape, length});
      if (found == classes.end()) return;
      const std::size_t rest = found->second.size() % lanes;
      if (rest == 0 || 2 * rest >= lanes) return;
      const std::vector<Piece> pieces(found->second.end() - static_cast<std::ptrdiff_t>(rest),
                                      found->second.end());
      found->second.resize(found->second.size() - rest);
      for (const Piece& piece : pieces) {
        if (shape == Shape::closed_fan) {
          classes[{law, Shape::open_fan, length}].push_back(piece);
        } else {
          const auto half = static_cast<std::uint8_t>(length / 2);
          classes[{law, Shape::open_fan, half}].push_back(piece);
          classes[{law, Shape::open_fan, static_cast<std::uint8_t>(length - half)}].push_back(
              {piece.item, static_cast<std::uint8_t>(piece.from + half)});
        }
      }
    };
    if (!cell(body.mesh.type).simplex || dimension(body.mesh.type) != 3) return classes;
    std::vector<std::uint16_t> laws;
    for (const auto& [key, pieces] : classes)
      if (laws.empty() || laws.back() != std::get<0>(key)) laws.push_back(std::get<0>(key));
    for (const std::uint16_t law : laws) {
      for (int length = simd::longest_fan; length >= 3; --length)
        cut_rest(law, Shape::closed_fan, static_cast<std::uint8_t>(length));
      for (int length = simd::longest_fan; length >= 2; --length)
        cut_rest(law, Shape::open_fan, static_cast<std::uint8_t>(length));
    }
    return classes;
  }

  /// Numbers the block's nodes: new to the thread, already used, shared with other threads; in each kind
  /// nodes with coordinates come first, in locality order. `state` of a node: 1 if this thread has used it,
  /// else 0; `slot`: its place in the thread's private sums if it is shared, else −1.
  void number_nodes(std::span<const std::uint32_t> members, std::vector<std::int32_t>& state,
                    std::span<const std::int32_t> slot, BlockRange& range) {
    std::vector<std::int32_t> found;
    for (const std::uint32_t u : members)
      for (std::uint32_t k = 0; k < items.node_count(u); ++k) {
        const std::int32_t node = item_nodes(u)[k];
        if (local[node] < 0) found.push_back(node);
        // 1 marks nodes without coordinates until they are numbered
        const std::int32_t seen = local[node] < 0 ? 1 : local[node];
        local[node] = items.is_placed(items.list[u].shape, k) ? 0 : seen;
      }
    const auto kind = [&](std::int32_t node) { return slot[node] >= 0 ? 2 : state[node]; };
    std::sort(found.begin(), found.end(), [&](std::int32_t a, std::int32_t b) {
      return std::make_tuple(kind(a), local[a], rank[a]) < std::make_tuple(kind(b), local[b], rank[b]);
    });
    range.first_node = layout.nodes.size();
    range.first_shared = layout.shared.size();
    range.first = range.again = 0;
    range.count = static_cast<std::uint32_t>(found.size());
    for (std::uint32_t i = 0; i < range.count; ++i) {
      const std::int32_t node = found[i];
      range.first += kind(node) == 0 ? 1 : 0;
      range.again += kind(node) <= 1 ? 1 : 0;
      range.placed[kind(node)] += local[node] == 0 ? 1 : 0;
      if (kind(node) == 2) layout.shared.push_back(slot[node]);
      local[node] = static_cast<std::int32_t>(i);
    }
    for (const std::int32_t node : found) state[node] = 1;
    layout.nodes.insert(layout.nodes.end(), found.begin(), found.end());
  }

  /// The caller's number of a point of a piece. Fans of tet10 reorder the corners of elements; each point
  /// stays next to its corner.
  std::int32_t point_of(const Piece& piece, Shape shape, std::uint32_t length, std::uint32_t point) const {
    const auto per_element = static_cast<std::uint32_t>(points_per_element(items.type));
    const std::uint32_t i = point / per_element;
    std::uint32_t q = point % per_element;
    const std::size_t element = at(items.elements[items.list[piece.item].first_element + piece.from + i]);
    if (items.type == ElementType::tet10) {
      const std::int32_t* corner = &body.mesh.connectivity[element * nodes_per_element(items.type)];
      const std::int32_t node = piece_node(piece, shape, items.node_of(shape, length, i, q));
      q = static_cast<std::uint32_t>(std::find(corner, corner + 4, node) - corner);
    }
    return static_cast<std::int32_t>(element * per_element + q);
  }

  /// Appends the batches of one class to the index and to the slots.
  void add_group(const Key& key, std::span<const Piece> pieces, BlockRange& range) {
    const auto [law, shape, length] = key;
    const std::size_t lanes = layout.lanes;
    const std::uint32_t nodes = items.nodes_of(shape, length), points = items.points_of(shape, length);
    const std::size_t batches = (pieces.size() + lanes - 1) / lanes;
    layout.groups.push_back({items.type, shape, length, law, static_cast<std::uint32_t>(batches),
                             static_cast<std::uint32_t>(layout.index.size() - range.first_index),
                             static_cast<std::uint32_t>(layout.element_point.size() - range.first_slot)});
    // Neighbouring tet10 share up to six nodes, and their sums depend on each other: put them in distant
    // lanes.
    const bool apart = cell(items.type).order == 2;
    const auto piece_of = [&](std::size_t batch, std::size_t lane) {
      return apart ? lane * batches + batch : batch * lanes + lane;
    };
    for (std::size_t batch = 0; batch < batches; ++batch) {
      for (std::uint32_t k = 0; k < nodes; ++k)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t i = piece_of(batch, lane);
          const std::uint32_t record =
              i < pieces.size() ? static_cast<std::uint32_t>(local[at(piece_node(pieces[i], shape, k))])
                                : range.count + idle_record(items.type, shape, length, k);
          layout.index.push_back(static_cast<std::uint16_t>(4 * record));
        }
      for (std::uint32_t point = 0; point < points; ++point)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t i = piece_of(batch, lane);
          std::int32_t target = -1;
          if (i < pieces.size()) {
            target = point_of(pieces[i], shape, length, point);
          }
          layout.element_point.push_back(target);
        }
    }
  }

  void add_block(std::span<const std::uint32_t> members, std::vector<std::int32_t>& state,
                 std::span<const std::int32_t> slot) {
    BlockRange range{};
    range.first_group = layout.groups.size();
    range.first_index = layout.index.size();
    range.first_slot = layout.element_point.size();
    range.first_record = layout.blocks.empty() ? 0
                                               : layout.blocks.back().first_record +
                                                     layout.blocks.back().count + layout.padding;
    number_nodes(members, state, slot, range);
    for (const auto& [key, pieces] : classify(members))
      if (!pieces.empty()) add_group(key, pieces, range);
    range.group_count = layout.groups.size() - range.first_group;
    for (std::size_t i = range.first_node; i < layout.nodes.size(); ++i) local[layout.nodes[i]] = -1;
    layout.largest = std::max(layout.largest, range.count + layout.padding);
    layout.blocks.push_back(range);
  }
};

/// Contiguous shares of blocks with nearly equal cost.
std::vector<std::size_t> share_blocks(const WorkItems& items,
                                      std::span<const std::vector<std::uint32_t>> blocks, int threads) {
  std::vector<double> cost(blocks.size() + 1, 0.0);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    cost[b + 1] = cost[b];
    for (const std::uint32_t u : blocks[b])  // a node costs about as much as a tetrahedron
      cost[b + 1] += items.node_count(u) + items.points_of(items.list[u].shape, items.list[u].length);
  }
  std::vector<std::size_t> share{0};
  for (int t = 1; t < threads; ++t) {
    const double wanted = cost.back() * t / threads;
    std::size_t cut = std::lower_bound(cost.begin(), cost.end(), wanted) - cost.begin();
    if (cut > 0 && wanted - cost[cut - 1] < cost[cut] - wanted) --cut;
    share.push_back(std::max(cut, share.back()));
  }
  share.push_back(blocks.size());
  return share;
}

/// Moves the blocks with early nodes to the front of their share.
void put_early_first(const Builder& builder, Layout& layout, std::span<const char> is_early,
                     std::span<std::vector<std::uint32_t>> blocks) {
  const auto has_early = [&](const std::vector<std::uint32_t>& members) {
    return std::any_of(members.begin(), members.end(), [&](std::uint32_t u) {
      const std::int32_t* nodes = builder.item_nodes(u);
      return std::any_of(nodes, nodes + builder.items.node_count(u),
                         [&](std::int32_t node) { return is_early[node] != 0; });
    });
  };
  for (std::size_t t = 0; t + 1 < layout.share.size(); ++t) {
    const auto mine = blocks.subspan(layout.share[t], layout.share[t + 1] - layout.share[t]);
    const auto rest = std::stable_partition(mine.begin(), mine.end(), has_early);
    layout.early.push_back(layout.share[t] + static_cast<std::size_t>(rest - mine.begin()));
  }
}

/// Finds the nodes of several threads. Returns each thread's slot of every node, −1 if it is not shared.
std::vector<std::vector<std::int32_t>> find_interface(const Builder& builder, Layout& layout,
                                                      std::span<const char> is_early,
                                                      std::span<const std::vector<std::uint32_t>> blocks) {
  const std::size_t nodes = builder.body.mesh.node_count(), threads = layout.share.size() - 1;
  std::vector<std::int32_t> owner(nodes, -1);  // a thread, or −2 for several
  const auto for_each_node = [&](std::size_t t, auto&& visit) {
    for (std::size_t b = layout.share[t]; b < layout.share[t + 1]; ++b)
      for (const std::uint32_t u : blocks[b])
        for (std::uint32_t k = 0; k < builder.items.node_count(u); ++k) visit(at(builder.item_nodes(u)[k]));
  };
  for (std::size_t t = 0; t < threads; ++t)
    for_each_node(t, [&](std::size_t node) {
      const auto thread = static_cast<std::int32_t>(t);
      owner[node] = owner[node] == -1 || owner[node] == thread ? thread : -2;
    });
  std::vector<std::vector<std::int32_t>> slot(threads, std::vector<std::int32_t>(nodes, -1));
  layout.slots_of_thread.assign(threads, 0);
  for (std::size_t t = 0; t < threads; ++t)
    for_each_node(t, [&](std::size_t node) {
      if (owner[node] == -2 && slot[t][node] < 0) slot[t][node] = layout.slots_of_thread[t]++;
    });
  layout.interface_first.push_back(0);
  for (const bool early : {true, false}) {
    for (std::size_t node = 0; node < nodes; ++node) {
      if ((is_early[node] != 0) != early) continue;
      if (owner[node] == -1) layout.unreferenced_nodes.push_back(static_cast<std::int32_t>(node));
      if (owner[node] != -2) continue;
      layout.interface_node.push_back(static_cast<std::int32_t>(node));
      for (std::size_t t = 0; t < threads; ++t)
        if (slot[t][node] >= 0) layout.contributions.push_back({static_cast<std::int32_t>(t), slot[t][node]});
      layout.interface_first.push_back(static_cast<std::uint32_t>(layout.contributions.size()));
    }
    if (early) layout.early_interface = layout.interface_node.size();
  }
  return slot;
}

}  // namespace

std::size_t Layout::records() const noexcept {
  return blocks.empty() ? 0 : blocks.back().first_record + blocks.back().count + padding;
}

std::size_t Layout::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.size() * sizeof(v[0]); };
  return size(blocks) + size(share) + size(early) + size(groups) + size(index) + size(nodes) +
         size(element_point) + size(shared) + size(interface_node) + size(interface_first) +
         size(contributions) + size(slots_of_thread) + size(unreferenced_nodes);
}

Layout make_layout(const Body& body, Partitioning partitioning, int lanes, int threads,
                   std::span<const std::int32_t> early) {
  separate_moduli(body, partitioning);
  Builder builder{body, partitioning.items, partitioning.rank, {}, {}};
  Layout& layout = builder.layout;
  layout.lanes = lanes;
  layout.padding = static_cast<std::uint32_t>(idle_positions(body.mesh.type).size());
  builder.local.assign(body.mesh.node_count(), -1);
  auto& blocks = partitioning.blocks;
  layout.share = share_blocks(builder.items, blocks, threads);
  std::vector<char> is_early(body.mesh.node_count(), 0);
  for (const std::int32_t node : early) is_early[node] = 1;
  put_early_first(builder, layout, is_early, blocks);
  const auto slot = find_interface(builder, layout, is_early, blocks);
  for (std::size_t t = 0; t + 1 < layout.share.size(); ++t) {
    std::vector<std::int32_t> state(body.mesh.node_count(), 0);
    for (std::size_t b = layout.share[t]; b < layout.share[t + 1]; ++b)
      builder.add_block(blocks[b], state, slot[t]);
  }
  layout.nodes.resize(layout.nodes.size() + simd::nodes_ahead, 0);
  layout.index.shrink_to_fit();
  layout.nodes.shrink_to_fit();
  layout.element_point.shrink_to_fit();
  return std::move(builder.layout);
}

namespace {

/// The first node's coordinate along each axis where those of all nodes lie between half and twice it:
/// differences are exact there (Sterbenz). Else 0: such blocks are as large as their coordinates.
std::array<double, 3> exact_origin(const MeshView& mesh, const std::int32_t* nodes, std::size_t count) {
  const std::size_t dim = dimension(mesh.type);
  std::array<double, 3> origin{};
  for (std::size_t k = 0; k < dim && count > 0; ++k) {
    const double first = mesh.coordinates[at(nodes[0]) * dim + k];
    bool exact = true;
    for (std::size_t i = 0; i < count && exact; ++i) {
      const double x = mesh.coordinates[at(nodes[i]) * dim + k];
      exact = x * first > 0.0 && std::abs(x) >= 0.5 * std::abs(first) && std::abs(x) <= 2.0 * std::abs(first);
    }
    if (exact) origin[k] = first;
  }
  return origin;
}

}  // namespace

template <class Real>
void fill_coordinates(const Layout& layout, const MeshView& mesh, std::span<Real> coordinates) {
  const std::size_t dim = dimension(mesh.type);
  const auto idle = idle_positions(mesh.type);
  for (const BlockRange& block : layout.blocks) {
    std::array<double, 3> middle{};
    const std::int32_t* nodes = layout.nodes.data() + block.first_node;
    for (std::size_t i = 0; i < block.count; ++i)
      for (std::size_t k = 0; k < dim; ++k)
        middle[k] += mesh.coordinates[at(nodes[i]) * dim + k] / block.count;
    // Single precision needs small numbers; in double precision the subtraction must be exact.
    if constexpr (std::is_same_v<Real, double>)
      middle = exact_origin(mesh, layout.nodes.data() + block.first_node, block.count);
    for (std::size_t i = 0; i < block.count; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        coordinates[4 * (block.first_record + i) + k] =
            k < dim ? static_cast<Real>(mesh.coordinates[at(nodes[i]) * dim + k] - middle[k]) : Real(0);
    // In 2D the third component holds the absolute radius.
    for (std::size_t i = 0; i < block.count && mesh.plane == PlaneState::axisymmetric; ++i)
      coordinates[4 * (block.first_record + i) + 2] = static_cast<Real>(mesh.coordinates[at(nodes[i]) * dim]);
    for (std::size_t i = 0; i < idle.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        coordinates[4 * (block.first_record + block.count + i) + k] = static_cast<Real>(idle[i][k]);
    for (std::size_t i = 0; i < idle.size() && mesh.plane == PlaneState::axisymmetric; ++i)
      coordinates[4 * (block.first_record + block.count + i) + 2] = Real(1);
  }
}

template void fill_coordinates<double>(const Layout&, const MeshView&, std::span<double>);
template void fill_coordinates<float>(const Layout&, const MeshView&, std::span<float>);

}  // namespace kacanov
