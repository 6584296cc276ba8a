// SPDX-License-Identifier: BSD-3-Clause
// Nodes of multi-node contact points, whose forces must be summed over the ranks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "linear/preconditioner.hpp"

namespace kacanov {

/// Local nodes that belong to multi-node points of any rank, and the summation over ranks of the forces that
/// the owners of these points compute. Empty, and without messages, if no rank has such points.
class WideNodes {
 public:
  /// Collective. The part must outlive it.
  explicit WideNodes(const Part& part);

  std::size_t size() const noexcept { return nodes_.size(); }
  /// Returns the position of a node in the list, which must contain it.
  std::size_t position(std::int32_t node) const noexcept;
  bool contains(std::int32_t node) const noexcept;

  /// Returns a zero vector over these nodes.
  std::vector<double> zeros(std::size_t width) const { return std::vector<double>(nodes_.size() * width); }
  /// y += sum of `forces` (nodes × dim) over all ranks; consistent. `forces` is overwritten. Collective.
  void add(std::span<double> forces, std::span<double> y) const;
  /// Returns the sums of `blocks` (nodes × dim × dim) over all ranks, for the nodes this rank owns.
  /// Collective.
  std::vector<NodeBlock> summed(std::vector<double> blocks) const;

 private:
  const Part* part_;
  std::vector<std::int32_t> nodes_;  ///< ascending
  IndexMap map_;                     ///< ranks that share them: lists of positions, for sums
};

}  // namespace kacanov
