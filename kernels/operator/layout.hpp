// SPDX-License-Identifier: BSD-3-Clause
// Partitioning of a body into blocks, and the operator's data in the order in which its loops read them:
// blocks, groups of batches, lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>
#include "operator/work_items.hpp"
#include "simd/block.hpp"

namespace kacanov {

struct Layout;

/// The part of the layout that does not depend on the number of lanes, and little on the precision.
struct Partitioning {
  WorkItems items;
  std::vector<std::vector<std::uint32_t>> blocks;  ///< work items of each block, in locality order
  std::vector<std::int32_t> rank;                  ///< per node: locality number, close for close nodes
};

/// Makes blocks that fit in a core's second-level cache with `record_bytes` per node record, at least one per
/// thread if the body is large enough.
Partitioning partition(const Body& body, int threads, std::size_t record_bytes);

/// Reuses the partitioning of an operator with the same mesh and law_of_element, merging `joined` of its
/// blocks into one. Skips the fan cover, METIS and the Hilbert curve, which take four fifths of the time.
Partitioning partition_as(const Layout& like, const Body& body, std::size_t joined);

/// A block: work items whose node records fit in a core's second-level cache. Ranges refer to Layout's
/// arrays.
struct BlockRange {
  std::size_t first_group, group_count;
  std::size_t first_index, first_slot;
  std::size_t first_record;  ///< in records (four values each)
  std::size_t first_node, first_shared;
  std::uint32_t first, again, count, placed[3];  ///< as in simd::Block
};

/// All data except material values, for batches of `lanes` lanes and `shares` threads.
struct Layout {
  int lanes = 1;
  std::vector<BlockRange> blocks;
  std::vector<std::size_t> share;  ///< blocks of thread t: share[t] … share[t+1]
  std::vector<std::size_t> early;  ///< share[t] … early[t]: the blocks of thread t with early nodes
  std::vector<simd::Group> groups;
  std::vector<std::uint16_t> index;
  std::vector<std::int32_t> nodes;          ///< per block, in the caller's numbering
  std::vector<std::int32_t> element_point;  ///< slot → element × points + point, −1 for idle lanes
  std::vector<std::int32_t> shared;         ///< see simd::Block
  std::uint32_t padding = 0;                ///< records behind those of each block
  std::uint32_t largest = 0;                ///< records of the largest block, padding included

  /// Nodes to which several threads add: contributions `interface_first[i]` … `[i+1]` belong to
  /// interface_node[i]; each is a slot in a thread's private sums.
  struct Contribution {
    std::int32_t thread, slot;
  };
  std::vector<std::int32_t> interface_node;  ///< early ones first
  std::size_t early_interface = 0;
  std::vector<std::uint32_t> interface_first;
  std::vector<Contribution> contributions;
  std::vector<std::int32_t> slots_of_thread;
  std::vector<std::int32_t> unreferenced_nodes;  ///< nodes that belong to no element

  /// Calls visit(slot, point) for every slot that is not idle. Capture pointers by value: through references
  /// the compiler reloads them at every slot, and the loop takes 1.5 times as long.
  template <class Visit>
  void for_each_point(const Visit& visit) const {
    const std::int32_t* const points = element_point.data();
    const std::size_t slots = element_point.size();
    for (std::size_t slot = 0; slot < slots; ++slot)
      if (const std::int32_t point = points[slot]; point >= 0) visit(slot, static_cast<std::size_t>(point));
  }
  std::size_t records() const noexcept;  ///< in all blocks
  std::size_t bytes() const noexcept;
};

/// `early` as in OperatorOptions.
Layout make_layout(const Body& body, Partitioning partitioning, int lanes, int threads,
                   std::span<const std::int32_t> early);

/// Records of local nodes for `layout`, with coordinates relative to the centre of the block.
template <class Real>
void fill_coordinates(const Layout& layout, const MeshView& mesh, std::span<Real> coordinates);

}  // namespace kacanov
