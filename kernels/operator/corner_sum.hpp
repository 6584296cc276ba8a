// SPDX-License-Identifier: BSD-3-Clause
// Sums over processes of what belongs to the corners round which tr ε is averaged.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "operator/corner_rows.hpp"

namespace kacanov {

/// What BasicOperator::set_corner_sum() wants, for `Real` float or double. Copies share their buffers.
template <class Real>
class CornerSum {
 public:
  /// `nodes`: the map of the nodes. All processes have to have the same `moduli`. Collective.
  CornerSum(const CornerMeans& means, const IndexMap& nodes);
  /// Adds up what all processes have for an entry. Collective.
  void operator()(std::span<Real> entries);

 private:
  struct State {
    explicit State(CornerRows all);
    CornerRows rows;
    std::vector<Real> values;  ///< of the rows; those without an entry here stay zero
    Scatterer<Real> scatterer;
  };
  std::shared_ptr<State> state_;  ///< null: there is one process
};

}  // namespace kacanov
