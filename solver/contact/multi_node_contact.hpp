// SPDX-License-Identifier: BSD-3-Clause
// The nodes of wide contact points, whose forces have to be added up over the ranks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "linear/preconditioner.hpp"

namespace kacanov {

/// Local nodes that wide points of any rank take part of, and the way to sum over the ranks what their
/// owners, who alone have these points, do to them. Empty, and without messages, where no rank has any.
class WideNodes {
 public:
  /// Collective. The part has to outlive it.
  explicit WideNodes(const Part& part);

  std::size_t size() const noexcept { return nodes_.size(); }
  /// Where a node that is among them stands.
  std::size_t position(std::int32_t node) const noexcept;
  bool contains(std::int32_t node) const noexcept;

  /// A vector of zeros over them.
  std::vector<double> zeros(std::size_t width) const { return std::vector<double>(nodes_.size() * width); }
  /// y += the sum of `forces` (nodes × dim) over all ranks; consistent. `forces` is used up. Collective.
  void add(std::span<double> forces, std::span<double> y) const;
  /// The sums of `blocks` (nodes × dim × dim) over all ranks, of the nodes this rank owns. Collective.
  std::vector<NodeBlock> summed(std::vector<double> blocks) const;

 private:
  const Part* part_;
  std::vector<std::int32_t> nodes_;  ///< ascending
  IndexMap map_;                     ///< who shares them: lists of positions, for sums
};

}  // namespace kacanov
