// SPDX-License-Identifier: BSD-3-Clause
// The corners around which an operator averages tr ε: their place in the blocks, and the sums of the threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "operator/layout.hpp"

namespace kacanov {

/// A corner of a block: its local node, the entry of its average, and the place that accumulates its volume
/// change: the entry's own, or, if several threads add to the entry, a private place of the thread behind all
/// entries.
struct BlockCorner {
  std::uint32_t node;
  std::int32_t entry, place;
};

struct CornerLayout {
  std::size_t entries = 0, places = 0;  ///< places: entries, then the threads' private places
  std::vector<std::size_t> first;       ///< corners of block b: first[b] … first[b+1]
  std::vector<BlockCorner> corners;
  /// Places to add to an entry: shared_first[i] … [i+1] of shared_place belong to shared_entry[i].
  std::vector<std::int32_t> shared_entry, shared_place;
  std::vector<std::size_t> shared_first;

  std::span<const BlockCorner> of(std::size_t block) const {
    return std::span(corners).subspan(first[block], first[block + 1] - first[block]);
  }
  std::size_t bytes() const noexcept;
};

CornerLayout make_corner_layout(const Body& body, const CornerMeans& means, const Layout& layout);

/// ∫ N over the elements of each corner or patch, as in reference::corner_changes().
std::vector<double> corner_volumes(const Body& body, const CornerMeans& means);

/// Splits blocks in which a corner has several entries, so that each corner has one entry per block.
void separate_moduli(const Body& body, Division& division);

}  // namespace kacanov
