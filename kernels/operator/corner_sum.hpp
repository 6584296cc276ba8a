// SPDX-License-Identifier: BSD-3-Clause
// Sums over processes of quantities at the corners around which tr ε is averaged.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "operator/corner_rows.hpp"

namespace kacanov {

/// The function that BasicOperator::set_corner_sum() expects, for `Real` float or double. Copies share
/// buffers.
template <class Real>
class CornerSum {
 public:
  /// `nodes`: index map of the nodes. All processes must have the same `moduli`. Collective.
  CornerSum(const CornerMeans& means, const IndexMap& nodes);
  /// Sums each entry over all processes. Collective.
  void operator()(std::span<Real> entries);

 private:
  struct State {
    explicit State(CornerRows all);
    CornerRows rows;
    std::vector<Real> values;  ///< of the rows; zero in rows without an entry on this rank
    Scatterer<Real> scatterer;
  };
  std::shared_ptr<State> state_;  ///< null with one process
};

}  // namespace kacanov
