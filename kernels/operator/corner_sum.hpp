// SPDX-License-Identifier: BSD-3-Clause
// Sums over processes of what belongs to the corners round which tr ε is averaged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/index_map.hpp>

namespace kacanov {

/// What BasicOperator::set_corner_sum() wants, for `Real` float or double.
template <class Real>
class CornerSum {
 public:
  /// The map, of the nodes, has to outlive it. All processes have to have the same `moduli`.
  CornerSum(const CornerMeans& means, const IndexMap& nodes);
  /// Adds up what all processes have for an entry. Collective.
  void operator()(std::span<Real> entries);

 private:
  struct Shared {
    std::int32_t entry;
    std::size_t place;
  };
  const IndexMap* nodes_;
  std::size_t width_;
  std::vector<Shared> shared_;
  std::vector<Real>
      of_node_;  ///< nodes × moduli, of which those that others have count; empty: there are none
};

}  // namespace kacanov
