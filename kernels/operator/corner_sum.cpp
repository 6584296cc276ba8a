// SPDX-License-Identifier: BSD-3-Clause
// Sums over processes of quantities at the corners around which tr ε is averaged.
#include "operator/corner_sum.hpp"

#include <algorithm>
#include <utility>

namespace kacanov {

template <class Real>
CornerSum<Real>::State::State(CornerRows all)
    : rows(std::move(all)), values(rows.map.size(), Real(0)), scatterer(rows.map, 1) {}

template <class Real>
CornerSum<Real>::CornerSum(const CornerMeans& means, const IndexMap& nodes) {
  if (nodes.ranks > 1) state_ = std::make_shared<State>(make_corner_rows(means, nodes));
}

template <class Real>
void CornerSum<Real>::operator()(std::span<Real> entries) {
  if (!state_) return;
  std::vector<Real>& values = state_->values;
  std::fill(values.begin(), values.end(), Real(0));
  for (std::size_t i = 0; i < entries.size(); ++i) values[state_->rows.of_entry[i]] = entries[i];
  state_->scatterer.start_sum(values);
  state_->scatterer.finish_sum(values);
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i] = values[state_->rows.of_entry[i]];
}

template class CornerSum<double>;
template class CornerSum<float>;

}  // namespace kacanov
