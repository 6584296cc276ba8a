// SPDX-License-Identifier: BSD-3-Clause
// The operator's data in the order in which its loops read them: blocks, groups of batches, lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>
#include "operator/division.hpp"
#include "simd/block.hpp"

namespace kacanov {

/// A block: units whose nodes' records fit in a core's second-level cache. Ranges refer to Layout's arrays.
struct BlockRange {
  std::size_t first_group, group_count;
  std::size_t first_index, first_slot;
  std::size_t first_record;  ///< in records (four values each)
  std::size_t first_node, first_shared;
  std::uint32_t first, again, count, placed[3];  ///< as in simd::Block
};

/// Everything but values of the material, for batches of `lanes` lanes and `shares` threads.
struct Layout {
  int lanes = 1;
  std::vector<BlockRange> blocks;
  std::vector<std::size_t> share;  ///< blocks of thread t: share[t] … share[t+1]
  std::vector<std::size_t> early;  ///< of these, share[t] … early[t] are all that have early nodes
  std::vector<simd::Group> groups;
  std::vector<std::uint16_t> index;
  std::vector<std::int32_t> nodes;          ///< of the blocks, in the caller's numbering
  std::vector<std::int32_t> element_point;  ///< slot → element × points + point, −1 for idle lanes
  std::vector<std::int32_t> shared;         ///< see simd::Block
  std::uint32_t padding = 0;                ///< records behind each block's own
  std::uint32_t largest = 0;                ///< records of the largest block, padding included

  /// Nodes that more than one thread adds to: contributions `interface_first[i]` … `[i+1]` belong to
  /// interface_node[i], each a slot in the private sums of a thread.
  struct Contribution {
    std::int32_t thread, slot;
  };
  std::vector<std::int32_t> interface_node;  ///< early ones first
  std::size_t early_interface = 0;
  std::vector<std::uint32_t> interface_first;
  std::vector<Contribution> contributions;
  std::vector<std::int32_t> slots_of_thread;
  std::vector<std::int32_t> lonely;  ///< nodes of no element

  std::size_t records() const noexcept;  ///< over all blocks
  std::size_t bytes() const noexcept;
};

/// `early` as in OperatorOptions.
Layout make_layout(const Body& body, Division division, int lanes, int threads,
                   std::span<const std::int32_t> early);

/// Records of local nodes, coordinates relative to the middle of their block, for `layout`.
template <class Real>
void fill_coordinates(const Layout& layout, const MeshView& mesh, std::span<Real> coordinates);

}  // namespace kacanov
